#include "segmenter/evaluation/recorded_session.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/log_reader.hpp"
#include "lcmtypes/stream_subscriber.hpp"
#include "segmenter/tools/cloud_slices.hpp"

namespace kintsugi::segmenter {
namespace {

/// What a log holds of one session of a mapper.
struct LoggedSession {
  std::map<std::int32_t, CloudSlice> slices;  // the newest revision, by id
  std::set<std::int32_t> corrected;           // ids that came in several revisions
  std::map<std::int64_t, CameraPose> poses;   // by time
  std::int64_t num_wrong_resolution = 0;      // slices left out

  void add(CloudSlice slice) {
    if (!slices.empty() && slice.resolution_m != slices.begin()->second.resolution_m) {
      ++num_wrong_resolution;
      return;
    }
    const auto [place, is_new] = slices.try_emplace(slice.id);
    if (!is_new && slice.revision != place->second.revision) corrected.insert(slice.id);
    if (is_new || slice.revision > place->second.revision) place->second = std::move(slice);
  }
};

using LoggedSessions = std::map<std::int64_t, LoggedSession>;

/// Everything in the log, and what was wrong with it.
LoggedSessions read_log(const std::filesystem::path& path, std::vector<std::string>& faults) {
  LogReader log(path);
  LoggedSessions sessions;
  std::int64_t num_bad_poses = 0;
  StreamSubscriber<CloudSlice> subscriber(channels::kCloudSlice, [&](CloudSlice slice) {
    LoggedSession& session = sessions[slice.session];
    session.add(std::move(slice));
  });
  while (const auto event = log.next()) {
    if (subscriber.handle(event->channel, event->data)) continue;
    if (event->channel != channels::kCameraPose) continue;
    try {
      const auto pose = decode<CameraPose>(event->data);
      sessions[pose.session].poses.emplace(pose.utime, pose);
    } catch (const DecodeError&) {
      ++num_bad_poses;
    }
  }
  const StreamCounts counts = subscriber.counts();
  if (log.damage()) faults.push_back(*log.damage());
  if (counts.messages_bad > 0) {
    faults.push_back(std::to_string(counts.messages_bad) + " messages on " + channels::kCloudSlice +
                     " could not be used");
  }
  if (num_bad_poses > 0) {
    faults.push_back(std::to_string(num_bad_poses) + " messages on " + channels::kCameraPose +
                     " could not be used");
  }
  return sessions;
}

LoggedSessions::iterator largest(LoggedSessions& sessions) {
  return std::max_element(sessions.begin(), sessions.end(), [](const auto& a, const auto& b) {
    return a.second.slices.size() < b.second.slices.size();
  });
}

double path_length_m(const std::vector<Pose>& X_WC) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < X_WC.size(); ++i) {
    length_m += (X_WC[i].translation() - X_WC[i - 1].translation()).norm();
  }
  return length_m;
}

/// Build time and path, from camera poses or, without them, from the slices.
void measure_path(const LoggedSession& logged, RecordedSession& session) {
  std::vector<Pose> path;
  std::int64_t first_us = session.slices.front().utime;
  for (const auto& [utime, pose] : logged.poses) {
    if (pose.state != TrackingState::kTracking && pose.state != TrackingState::kGiven) continue;
    if (path.empty()) first_us = std::min(first_us, utime);
    path.push_back(pose.X_WC);
  }
  if (path.empty()) {
    for (const CloudSlice& slice : session.slices) path.push_back(slice.X_WC);
    session.remarks.push_back(
        "No camera poses in the log: build time and length count from the "
        "first slice and along the cameras of the slices only.");
  }
  std::int64_t last_us = first_us;
  for (const CloudSlice& slice : session.slices) last_us = std::max(last_us, slice.utime);
  session.build_time_s = static_cast<double>(last_us - first_us) * 1e-6;
  session.path_length_m = path_length_m(path);
}

/// What is missing or was left out of the session.
void remark_gaps(const LoggedSession& logged, RecordedSession& session) {
  const std::int64_t num_missing =
      std::int64_t{session.slices.back().id} + 1 - static_cast<std::int64_t>(session.slices.size());
  if (num_missing > 0) {
    session.is_whole = false;
    session.remarks.push_back(std::to_string(num_missing) +
                              " slices are missing from the log; it was evaluated without them.");
  }
  if (session.slices.back().kind != SliceKind::kFinal) {
    session.is_whole = false;
    session.remarks.push_back("The log ends before the final slice of the map.");
  }
  if (!logged.corrected.empty()) {
    session.remarks.push_back(std::to_string(logged.corrected.size()) +
                              " slices came with corrections; the newest revision of each was "
                              "replayed in its place.");
  }
  if (logged.num_wrong_resolution > 0) {
    session.is_whole = false;
    session.remarks.push_back(std::to_string(logged.num_wrong_resolution) +
                              " slices of another resolution were left out.");
  }
}

}  // namespace

std::int64_t RecordedSession::num_points() const {
  std::int64_t count = 0;
  for (const CloudSlice& slice : slices) count += static_cast<std::int64_t>(slice.points_W.size());
  return count;
}

RecordedSession read_session_log(const std::filesystem::path& path) {
  RecordedSession session;
  session.source = path.string();
  session.has_times = true;
  LoggedSessions sessions = read_log(path, session.remarks);
  session.is_whole = session.remarks.empty();

  const auto chosen = largest(sessions);
  const std::string damage = session.is_whole ? "" : " (" + session.remarks.front() + ")";
  if (chosen == sessions.end() || chosen->second.slices.empty()) {
    throw std::runtime_error(path.string() + ": holds no slice that could be read on " +
                             channels::kCloudSlice + damage);
  }
  LoggedSession& logged = chosen->second;
  for (auto& [id, slice] : logged.slices) session.slices.push_back(std::move(slice));
  if (session.num_points() == 0) {
    throw std::runtime_error(path.string() + ": its slices hold no points" + damage);
  }
  const auto with_slices = std::count_if(sessions.begin(), sessions.end(), [](const auto& entry) {
    return !entry.second.slices.empty();
  });
  if (with_slices > 1) {
    session.remarks.push_back("The log holds " + std::to_string(with_slices) +
                              " sessions with slices; the one with most, " +
                              std::to_string(chosen->first) + ", was evaluated.");
  }
  remark_gaps(logged, session);
  measure_path(logged, session);
  return session;
}

RecordedSession read_session_cloud(const std::filesystem::path& path,
                                   const CloudInputConfig& config) {
  const CloudInput input = read_cloud(path, config);
  RecordedSession session;
  session.source = path.string();
  session.slices =
      cut_into_slices(input.cloud, input.resolution_m, path.filename().string()).slices;
  session.remarks.push_back("A cloud has no times: build time, length and Table II are left out.");
  if (input.cloud.slice_ids.empty()) {
    session.remarks.push_back("The cloud has no slice_id: it was evaluated as a single slice.");
  }
  return session;
}

}  // namespace kintsugi::segmenter

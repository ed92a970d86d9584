#include "segmenter/evaluation/session/session_log.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/whole_log_reader.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"

namespace kintsugi::segmenter {
namespace {

/// The contents of a log for one mapper session.
struct LoggedSession {
  SliceSequencer order{{}};
  std::vector<SliceGroup> steps;
  std::int64_t num_slices = 0;
  std::int64_t num_corrections = 0;
  std::int64_t num_wrong_resolution = 0;     // slices left out
  std::optional<float> resolution_m;         // of the first
  std::map<std::int64_t, CameraPose> poses;  // by time
  std::optional<std::int64_t> num_segments;  // in the last status of a segmenter that had finished

  void add(CloudSlice slice) {
    if (slice.resolution_m != resolution_m.value_or(slice.resolution_m)) {
      ++num_wrong_resolution;
      return;
    }
    resolution_m = slice.resolution_m;
    const auto verdict = order.offer(std::move(slice), {});
    num_slices += verdict == SliceSequencer::Verdict::kTaken;
    num_corrections += verdict == SliceSequencer::Verdict::kCorrected;
    take(Outlook::kSilent);
  }

  /// Takes what is left, without the missing slices.
  void end() {
    do take(Outlook::kEnded);
    while (order.give_up_gap({}, Outlook::kEnded));
  }

 private:
  void take(Outlook outlook) {
    while (auto step = order.pop({}, outlook)) steps.push_back(*std::move(step));
  }
};

using LoggedSessions = std::map<std::int64_t, LoggedSession>;

/// A status that cannot be read says nothing: the evaluation does not need it.
void note_segments(std::span<const std::uint8_t> data, LoggedSessions& sessions) {
  try {
    const auto status = decode<SegmenterStatus>(data);
    if (status.finished) sessions[status.map_session].num_segments = status.segments;
  } catch (const DecodeError&) {
  }
}

/// Reads all sessions of the log; adds to `faults` what was wrong with it.
LoggedSessions read_log(const std::filesystem::path& path, std::vector<std::string>& faults) {
  WholeLogReader log(path);
  LoggedSessions sessions;
  std::int64_t num_bad_poses = 0;
  StreamSubscriber<CloudSlice> subscriber(channels::kCloudSlice, [&](CloudSlice slice) {
    LoggedSession& session = sessions[slice.session];
    session.add(std::move(slice));
  });
  while (const auto event = log.next()) {
    if (subscriber.handle(event->channel, event->data)) continue;
    if (event->channel == channels::kSegmenterStatus) note_segments(event->data, sessions);
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
    return a.second.num_slices < b.second.num_slices;
  });
}

double path_length_m(const std::vector<Pose>& X_WC) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < X_WC.size(); ++i) {
    length_m += (X_WC[i].translation() - X_WC[i - 1].translation()).norm();
  }
  return length_m;
}

/// Sets build time and path length, from camera poses or, without them, from the slices.
void measure_path(const LoggedSession& logged, RecordedSession& session) {
  const std::vector<const CloudSlice*> slices = session.newest_slices();
  std::vector<Pose> path;
  std::int64_t first_us = slices.front()->utime;
  for (const auto& [utime, pose] : logged.poses) {
    if (!is_located(pose.state)) continue;
    if (path.empty()) first_us = std::min(first_us, utime);
    path.push_back(pose.X_WC);
  }
  if (path.empty()) {
    for (const CloudSlice* slice : slices) path.push_back(slice->X_WC);
    session.remarks.push_back(
        "No camera poses in the log: build time and length count from the first slice and along "
        "the cameras of the slices only.");
  }
  std::int64_t last_us = first_us;
  for (const CloudSlice* slice : slices) last_us = std::max(last_us, slice->utime);
  session.build_time_s = static_cast<double>(last_us - first_us) * 1e-6;
  session.path_length_m = path_length_m(path);
}

/// Every surface is evaluated where the last correction of the map has put it.
void apply_corrections_of(RecordedSession& session) {
  std::vector<CloudSlice*> slices;
  bool is_corrected = false;
  for (SliceGroup& step : session.steps) {
    for (CloudSlice& slice : step.slices) {
      slices.push_back(&slice);
      is_corrected = is_corrected || slice.kind == SliceKind::kCorrection;
    }
  }
  apply_corrections(slices);
  if (is_corrected) {
    session.remarks.push_back(
        "The mapper corrected the map: patches were segmented where the last correction has put "
        "them.");
  }
}

/// Adds remarks about what is missing, was left out or was corrected.
void add_remarks(const LoggedSession& logged, RecordedSession& session) {
  if (const auto num_missing = logged.order.num_missing(); num_missing > 0) {
    session.is_whole = false;
    session.remarks.push_back(std::to_string(num_missing) +
                              " slices are missing from the log; it was evaluated without them.");
  }
  if (session.newest_slices().back()->kind != SliceKind::kFinal) {
    session.is_whole = false;
    session.remarks.push_back("The log ends before the final slice of the map.");
  }
  if (logged.num_corrections > 0) {
    session.remarks.push_back(
        std::to_string(logged.num_corrections) +
        " corrections of slices were segmented in the order in which they were recorded.");
  }
  if (logged.num_wrong_resolution > 0) {
    session.is_whole = false;
    session.remarks.push_back(std::to_string(logged.num_wrong_resolution) +
                              " slices of another resolution were left out.");
  }
}

}  // namespace

RecordedSession read_session_log(const std::filesystem::path& path) {
  RecordedSession session;
  session.source = path.string();
  session.has_times = true;
  LoggedSessions sessions = read_log(path, session.remarks);
  session.is_whole = session.remarks.empty();

  const auto chosen = largest(sessions);
  const std::string damage = session.is_whole ? "" : " (" + session.remarks.front() + ")";
  if (chosen == sessions.end() || chosen->second.num_slices == 0) {
    throw std::runtime_error(path.string() + ": holds no slice that could be read on " +
                             channels::kCloudSlice + damage);
  }
  LoggedSession& logged = chosen->second;
  logged.end();
  session.steps = std::move(logged.steps);
  session.num_slices = logged.num_slices;
  session.segments_of_run = logged.num_segments;
  apply_corrections_of(session);
  if (session.num_points() == 0) {
    throw std::runtime_error(path.string() + ": its slices hold no points" + damage);
  }
  const auto with_slices = std::ranges::count_if(
      sessions, [](const auto& entry) { return entry.second.num_slices > 0; });
  if (with_slices > 1) {
    session.remarks.push_back("The log holds " + std::to_string(with_slices) +
                              " sessions with slices; the one with most, " +
                              std::to_string(chosen->first) + ", was evaluated.");
  }
  add_remarks(logged, session);
  measure_path(logged, session);
  return session;
}

}  // namespace kintsugi::segmenter

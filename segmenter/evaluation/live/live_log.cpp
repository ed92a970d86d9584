#include "segmenter/evaluation/live/live_log.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/whole_log_reader.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"

namespace kintsugi::segmenter {
namespace {

using Sessions = std::map<std::int64_t, LiveEvaluation>;  // by session of the mapper

/// What is wrong with one channel of the log, for a reader.
void remark(const char* channel, const StreamCounts& counts, LiveLogReport& result) {
  if (counts.messages_bad > 0) {
    result.remarks.push_back(
        fmt::format("{} messages on {} could not be used", counts.messages_bad, channel));
  }
  if (counts.chunks_missing > 0) {
    result.remarks.push_back(
        fmt::format("{} chunks of {} are missing in the log", counts.chunks_missing, channel));
  }
}

Sessions read_log(const std::filesystem::path& path, const LiveConfig& config,
                  LiveLogReport& result) {
  Sessions sessions;
  double now_s = 0.0;
  const auto session_of = [&](std::int64_t session) -> LiveEvaluation& {
    return sessions.try_emplace(session, config).first->second;
  };
  StreamSubscriber<CloudSlice> slices(channels::kCloudSlice, [&](CloudSlice slice) {
    LiveEvaluation& session = session_of(slice.session);
    session.add(std::move(slice), now_s);
  });
  StreamSubscriber<SegmentUpdate> updates(
      channels::kSegmentUpdate,
      [&](const SegmentUpdate& update) { session_of(update.map_session).add(update, now_s); });
  StreamSubscriber<CameraView> views(channels::kCameraView, [&](const CameraView& view) {
    session_of(view.session).add(view, now_s);
  });
  WholeLogReader log(path);
  while (const auto event = log.next()) {
    now_s = 1e-6 * static_cast<double>(event->utime);
    slices.handle(event->channel, event->data);
    updates.handle(event->channel, event->data);
    views.handle(event->channel, event->data);
  }
  if (log.damage()) result.remarks.push_back(*log.damage());
  remark(channels::kCloudSlice, slices.counts(), result);
  remark(channels::kSegmentUpdate, updates.counts(), result);
  return sessions;
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) {
  throw std::runtime_error(path.string() + ": " + what);
}

}  // namespace

LiveLogReport evaluate_live_log(const std::filesystem::path& path, const LiveConfig& config) {
  LiveLogReport result;
  result.source = path.string();
  Sessions sessions = read_log(path, config, result);
  result.is_whole = result.remarks.empty();
  const auto chosen = std::ranges::max_element(
      sessions, {}, [](const auto& session) { return session.second.num_views(); });
  if (chosen == sessions.end() || chosen->second.num_views() == 0) {
    refuse(path, "holds no view of the camera (CAMERA_VIEW)");
  }
  result.report = chosen->second.report();
  result.report.session = chosen->first;
  if (result.report.revisions_sent == 0) refuse(path, "holds no slice of the map (CLOUD_SLICE)");
  if (result.report.num_points == 0) refuse(path, "holds no labels of its slices (SEGMENT_UPDATE)");
  const auto with_views = std::ranges::count_if(
      sessions, [](const auto& session) { return session.second.num_views() > 0; });
  if (with_views > 1) {
    result.remarks.push_back(
        fmt::format("the log has views of {} sessions; the one with most, {}, was evaluated",
                    with_views, chosen->first));
  }
  return result;
}

}  // namespace kintsugi::segmenter

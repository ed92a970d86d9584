#include "mapper/process/map_publisher.hpp"

#include <algorithm>
#include <utility>

#include "lcmtypes/base/service_notice.hpp"
#include "lcmtypes/bus/message_subscriber.hpp"
#include "lcmtypes/channels.hpp"
#include "mapper/session/mapping_options.hpp"
#include "mapper/session/stored_stream.hpp"
#include "mapper/source/bus/rgbd_frame_encoder.hpp"

namespace kintsugi::mapper {

MapPublisher::MapPublisher(const Config& config, SessionStore& store)
    : config_(config),
      store_(store),
      bus_(config.lcm_url),
      slice_stream_(slice_stream(config.session, config.map_name)),
      view_stream_(bus_, channels::kCameraView, config.session, stream_config(config.map_name)) {
  if (!config_.join.empty()) {
    // Its heartbeats name the map for which the keyframes are.
    keyframe_stream_ = std::make_unique<StreamPublisher>(
        bus_, channels::kKeyframe, config_.session, stream_config(config_.join),
        &store_.stream(channels::kKeyframe, config_.session));
  }
  if (config_.publish_frames) {
    frame_stream_ = std::make_unique<StreamPublisher>(bus_, channels::kRgbdFrame, config_.session,
                                                      stream_config(config_.map_name));
  }
  serve_stored_sessions();
  kintsugi::subscribe<ResendRequest>(bus_, channels::kResendRequest,
                                     [this](const ResendRequest& request) { answer(request); });
  bus_thread_.emplace(bus_, [this] { store_.retry(); });
}

StreamPublisher::Config MapPublisher::stream_config(const std::string& map_name) const {
  StreamPublisher::Config config = config_.stream;
  config.max_chunk_bytes = bus_.max_message_bytes();
  config.map_name = map_name;
  return config;
}

/// Made when it is not there yet.
StreamPublisher& MapPublisher::slice_stream(std::int64_t session, const std::string& map_name) {
  const std::scoped_lock lock(mutex_);
  const bool is_of_run = session >= config_.session;  // not only in its log
  Stream& stream = slice_streams_[session];
  if (!stream) {
    stream = std::make_unique<StreamPublisher>(
        [this, is_of_run](const std::string& channel, ByteView message) {
          // Streams store their chunks themselves.
          if (is_of_run && channel == channels::kHeartbeat) store_.add(channel, message);
          bus_.publish(channel, message);
        },
        channels::kCloudSlice, session, stream_config(map_name),
        &store_.stream(channels::kCloudSlice, session));
  }
  return *stream;
}

void MapPublisher::serve_stored_sessions() {
  for (const StoredSession& stored : store_.sessions()) {
    const auto name = stored.options.find(kMapNameOption);
    slice_stream(stored.session, name == stored.options.end() ? "" : name->second);
  }
}

void MapPublisher::answer(const ResendRequest& request) {
  const std::scoped_lock lock(mutex_);
  const auto stream = slice_streams_.find(request.session);
  if (stream != slice_streams_.end()) stream->second->request(request);
  if (keyframe_stream_) keyframe_stream_->request(request);
}

MapPublisher::Published MapPublisher::published() const {
  return {.slices = slices_published_,
          .points = points_published_,
          .chunks = slice_stream_.chunks_published()};
}

template <SmallMessage Message>
void MapPublisher::publish(const std::string& channel, const Message& message) {
  const Bytes bytes = encode(message);
  store_.add(channel, bytes);
  bus_.publish(channel, bytes);
}

void MapPublisher::publish_slices(std::vector<CloudSlice> slices) {
  for (CloudSlice& slice : slices) {
    slice.session = config_.session;
    slice.map_name = config_.map_name;
    points_published_ += static_cast<std::int64_t>(slice.points_W.size());
    ++slices_published_;
    if (slice.kind == SliceKind::kPatch) {
      slice_stream_.publish_patch(std::move(slice), config_.supersede_patches);
    } else {
      slice_stream_.publish(std::move(slice));
    }
  }
}

void MapPublisher::publish_pose(CameraPose pose) {
  pose.session = config_.session;
  publish(channels::kCameraPose, pose);
}

void MapPublisher::publish_keyframe(KeyframeMessage keyframe) {
  if (!keyframe_stream_) return;
  keyframe.session = config_.session;
  keyframe.map_name = config_.map_name;
  keyframe.join = config_.join;
  keyframe_stream_->publish(std::move(keyframe));
}

void MapPublisher::publish_view(CameraView view) {
  if (view_stream_.queued_bytes() > 0) return;
  view.session = config_.session;
  view.map_name = config_.map_name;
  view_stream_.publish(std::move(view));
}

void MapPublisher::publish_status(MapperStatus status) {
  status.utime = wall_clock_us();
  status.session = config_.session;
  status.map_name = config_.map_name;
  status.join = config_.join;
  // Those of a completed session were published earlier.
  status.slices_published += slices_published_;
  status.points_published += points_published_;
  status.chunks_published = slice_stream_.chunks_published();
  status.queue_bytes = static_cast<std::int64_t>(queued_bytes());
  for (const auto& [session, stream] : slice_streams_) {
    const StreamPublisherCounts counts = stream->counts();
    status.chunks_resent += counts.chunks_resent;
    status.requests_received += counts.requests_received;
    status.patches_superseded += counts.messages_superseded;
  }
  report_refused(status);
  const BufferedLog::Report report = store_.report();
  status.store_bytes = report.size_bytes;
  status.store_waiting_bytes = report.waiting_bytes;
  status.store_lost_chunks = report.lost_chunks;
  status.store_problem = report.problem.substr(0, kMaxStringBytes);
  publish(channels::kMapperStatus, status);
  tell_service_manager();
}

void MapPublisher::publish_frame(const RgbdFrame& frame) {
  if (frame_stream_)
    frame_stream_->publish(encode_rgbd_frame(frame, config_.session, config_.jpeg_quality));
}

void MapPublisher::flush() {
  for (const auto& [session, stream] : slice_streams_) stream->flush();
  if (keyframe_stream_) keyframe_stream_->flush();
  if (frame_stream_) frame_stream_->flush();
}

double MapPublisher::time_since_request_s() const {
  double time_s = slice_stream_.time_since_request_s();
  for (const auto& [session, stream] : slice_streams_) {
    time_s = std::min(time_s, stream->time_since_request_s());
  }
  if (keyframe_stream_) time_s = std::min(time_s, keyframe_stream_->time_since_request_s());
  return time_s;
}

std::size_t MapPublisher::queued_slice_bytes() const {
  std::size_t bytes = 0;
  for (const auto& [session, stream] : slice_streams_) bytes += stream->queued_bytes();
  return bytes;
}

std::size_t MapPublisher::queued_frame_bytes() const {
  return frame_stream_ ? frame_stream_->queued_bytes() : 0;
}

bool MapPublisher::has_room() const {
  const double max_bytes = config_.max_queue_s * config_.stream.rate_bytes_per_s;
  return static_cast<double>(std::max(queued_slice_bytes(), queued_frame_bytes())) <= max_bytes;
}

MapPublisher::Config publisher_config(const Options& options, std::int64_t session) {
  MapPublisher::Config config;
  config.lcm_url = options.lcm_url;
  config.map_name = options.map_name;
  config.join = options.join;
  config.session = session;
  config.publish_frames = options.publish_frames;
  config.supersede_patches = !options.source.replay;
  config.stream.rate_bytes_per_s = 1e6 * options.rate_mb_s;
  return config;
}

}  // namespace kintsugi::mapper

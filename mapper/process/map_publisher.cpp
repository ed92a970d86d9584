#include "mapper/process/map_publisher.hpp"

#include <algorithm>
#include <utility>

#include "lcmtypes/channels.hpp"
#include "mapper/session/mapping_options.hpp"
#include "mapper/session/stored_stream.hpp"
#include "mapper/source/bus/rgbd_frame_encoder.hpp"

namespace kintsugi::mapper {

MapPublisher::MapPublisher(const Config& config, SessionStore& store)
    : config_(config), store_(store), bus_(config.lcm_url) {
  const auto send = [this](const std::string& channel, ByteView message) {
    if (channel == channels::kHeartbeat)
      store_.add(channel, message);  // streams store their chunks themselves
    bus_.publish(channel, message);
  };
  slice_stream_ = std::make_unique<StreamPublisher>(
      send, channels::kCloudSlice, config_.session, stream_config(config_.map_name),
      &store_.stream(channels::kCloudSlice, config_.session));
  slice_stream_->subscribe(bus_);
  if (config_.publish_frames) {
    frame_stream_ = std::make_unique<StreamPublisher>(bus_, channels::kRgbdFrame, config_.session,
                                                      stream_config(config_.map_name));
  }
  serve_earlier_sessions();
  bus_thread_.emplace(bus_, [this] { store_.retry(); });
}

StreamPublisher::Config MapPublisher::stream_config(const std::string& map_name) const {
  StreamPublisher::Config config = config_.stream;
  config.max_chunk_bytes = bus_.max_message_bytes();
  config.map_name = map_name;
  return config;
}

void MapPublisher::serve_earlier_sessions() {
  for (const StoredSession& earlier : store_.sessions()) {
    if (earlier.session == config_.session) continue;
    const auto name = earlier.options.find(kMapNameOption);
    earlier_sessions_.push_back(std::make_unique<StreamPublisher>(
        bus_, channels::kCloudSlice, earlier.session,
        stream_config(name == earlier.options.end() ? "" : name->second),
        &store_.stream(channels::kCloudSlice, earlier.session)));
    earlier_sessions_.back()->subscribe(bus_);
  }
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
    slice_stream_->publish(std::move(slice));
  }
}

void MapPublisher::publish_pose(CameraPose pose) {
  pose.session = config_.session;
  publish(channels::kCameraPose, pose);
}

void MapPublisher::publish_status(MapperStatus status) {
  status.utime = wall_clock_us();
  status.session = config_.session;
  status.map_name = config_.map_name;
  status.slices_published +=
      slices_published_;  // those of a completed session were published earlier
  status.points_published += points_published_;
  status.chunks_published = chunks_published();
  status.queue_bytes = static_cast<std::int64_t>(queued_bytes());
  const auto add_counts = [&status](const StreamPublisher& stream) {
    const StreamPublisherCounts counts = stream.counts();
    status.chunks_resent += counts.chunks_resent;
    status.requests_received += counts.requests_received;
  };
  add_counts(*slice_stream_);
  for (const Stream& earlier : earlier_sessions_) add_counts(*earlier);
  const BufferedLog::Report report = store_.report();
  status.store_bytes = report.size_bytes;
  status.store_waiting_bytes = report.waiting_bytes;
  status.store_lost_chunks = report.lost_chunks;
  status.store_problem = report.problem.substr(0, kMaxStringBytes);
  publish(channels::kMapperStatus, status);
}

void MapPublisher::publish_frame(const RgbdFrame& frame) {
  if (frame_stream_)
    frame_stream_->publish(encode_rgbd_frame(frame, config_.session, config_.jpeg_quality));
}

void MapPublisher::flush() {
  slice_stream_->flush();
  if (frame_stream_) frame_stream_->flush();
}

double MapPublisher::time_since_request_s() const {
  double time_s = slice_stream_->time_since_request_s();
  for (const Stream& earlier : earlier_sessions_) {
    time_s = std::min(time_s, earlier->time_since_request_s());
  }
  return time_s;
}

std::size_t MapPublisher::queued_bytes() const {
  return slice_stream_->queued_bytes() + (frame_stream_ ? frame_stream_->queued_bytes() : 0);
}

bool MapPublisher::has_room() const {
  const double max_bytes = config_.max_queue_s * config_.stream.rate_bytes_per_s;
  const auto has_room = [max_bytes](const Stream& stream) {
    return !stream || static_cast<double>(stream->queued_bytes()) <= max_bytes;
  };
  return has_room(slice_stream_) && has_room(frame_stream_);
}

MapPublisher::Config publisher_config(const Options& options, std::int64_t session) {
  MapPublisher::Config config;
  config.lcm_url = options.lcm_url;
  config.map_name = options.map_name;
  config.session = session;
  config.publish_frames = options.publish_frames;
  config.stream.rate_bytes_per_s = 1e6 * options.rate_mb_s;
  return config;
}

}  // namespace kintsugi::mapper

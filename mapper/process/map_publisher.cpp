#include "mapper/process/map_publisher.hpp"

#include <utility>

#include "lcmtypes/channels.hpp"
#include "mapper/source/rgbd_frame_encoder.hpp"

namespace kintsugi::mapper {

MapPublisher::MapPublisher(const Config& config)
    : config_(config),
      bus_(config.lcm_url),
      slice_stream_(bus_, channels::kCloudSlice, config.session, config.stream) {
  if (config_.publish_frames) {
    frame_stream_.emplace(bus_, channels::kRgbdFrame, config.session, config.stream);
  }
}

void MapPublisher::publish_slices(std::vector<CloudSlice> slices) {
  for (CloudSlice& slice : slices) {
    slice.session = config_.session;
    slice.map_name = config_.map_name;
    points_published_ += static_cast<std::int64_t>(slice.points_W.size());
    ++slices_published_;
    slice_stream_.publish(std::move(slice));
  }
}

void MapPublisher::publish_pose(CameraPose pose) {
  pose.session = config_.session;
  bus_.publish(channels::kCameraPose, pose);
}

void MapPublisher::publish_status(MapperStatus status) {
  status.utime = wall_clock_us();
  status.session = config_.session;
  status.map_name = config_.map_name;
  status.slices_published = slices_published_;
  status.points_published = points_published_;
  status.chunks_published = chunks_published();
  bus_.publish(channels::kMapperStatus, status);
}

void MapPublisher::publish_frame(const RgbdFrame& frame) {
  if (frame_stream_)
    frame_stream_->publish(encode_rgbd_frame(frame, config_.session, config_.jpeg_quality));
}

void MapPublisher::flush() {
  slice_stream_.flush();
  if (frame_stream_) frame_stream_->flush();
}

std::size_t MapPublisher::queued_bytes() const {
  return slice_stream_.queued_bytes() + (frame_stream_ ? frame_stream_->queued_bytes() : 0);
}

bool MapPublisher::has_room() const {
  return slice_stream_.queued_bytes() <= config_.max_queued_bytes &&
         (!frame_stream_ || frame_stream_->queued_bytes() <= config_.max_queued_bytes);
}

}  // namespace kintsugi::mapper

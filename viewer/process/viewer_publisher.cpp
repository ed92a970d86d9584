#include "viewer/process/viewer_publisher.hpp"

#include <utility>

#include "lcmtypes/base/service_notice.hpp"
#include "lcmtypes/channels.hpp"
#include "viewer/output/picture_file.hpp"

namespace kintsugi::viewer {
namespace {

/// Without a store for resends: a lost picture is replaced by the next one.
StreamPublisher::Config stream_config(const Bus& bus) {
  StreamPublisher::Config config;
  config.max_chunk_bytes = bus.max_message_bytes();
  return config;
}

}  // namespace

ViewerPublisher::ViewerPublisher(Bus& bus)
    : bus_(bus),
      session_(new_session()),
      pictures_(bus, channels::kSnapshot, session_, stream_config(bus)) {}

void ViewerPublisher::publish_picture(const cv::Mat3b& picture, const std::string& caption) {
  constexpr int kJpegQuality = 85;
  Snapshot snapshot;
  snapshot.utime = wall_clock_us();
  snapshot.session = session_;
  snapshot.caption = caption;
  snapshot.width = picture.cols;
  snapshot.height = picture.rows;
  snapshot.image_jpeg = encode_jpeg(picture, kJpegQuality);
  pictures_.publish(std::move(snapshot));
}

void ViewerPublisher::publish_status(ViewerStatus status) {
  status.utime = wall_clock_us();
  status.session = session_;
  bus_.publish(channels::kViewerStatus, status);
  tell_service_manager();
  next_status_ = Clock::now() + std::chrono::milliseconds(500);
}

bool ViewerPublisher::status_is_due() const { return Clock::now() >= next_status_; }

void ViewerPublisher::flush() { pictures_.flush(); }

}  // namespace kintsugi::viewer

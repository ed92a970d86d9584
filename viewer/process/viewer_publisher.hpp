#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include <opencv2/core.hpp>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"

namespace kintsugi::viewer {

/// Publishes the pictures and the status of one run of the viewer.
class ViewerPublisher {
 public:
  explicit ViewerPublisher(Bus& bus);

  std::int64_t session() const { return session_; }  ///< number of this run

  /// Publishes the picture as JPEG, in chunks.
  void publish_picture(const cv::Mat3b& picture, const std::string& caption);

  /// Publishes `status` with the wall clock and this run's session.
  void publish_status(ViewerStatus status);
  /// Half a second has passed since the last status.
  bool status_is_due() const;

  /// Waits until all pictures are sent.
  void flush();

 private:
  using Clock = std::chrono::steady_clock;

  Bus& bus_;
  std::int64_t session_;
  StreamPublisher pictures_;
  Clock::time_point next_status_ = Clock::now();
};

}  // namespace kintsugi::viewer

#pragma once
// Views of the camera in an LCM log, for tests.

#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "tests/segmenter/evaluation/session/log_of_slices.hpp"
#include "tests/segmenter/query/camera_view.hpp"

namespace kintsugi::segmenter::testing {

/// From (x_m, 0, 0), of a wall 2 m in front.
inline CameraView view_at(double x_m, std::int64_t utime, std::int64_t session = 5) {
  Pose X_WC = Pose::Identity();
  X_WC.translation().x() = x_m;
  CameraView view = view_of_wall(session, X_WC, 2.0);
  view.utime = utime;
  return view;
}

inline void append_views(const std::vector<CameraView>& views, LogMessages& messages) {
  if (views.empty()) return;
  StreamPublisher::Config config;
  config.rate_bytes_per_s = 1e12;  // nobody to overrun
  StreamPublisher publisher(
      [&](const std::string& channel, ByteView message) {
        messages.emplace_back(channel, Bytes(message.begin(), message.end()));
      },
      channels::kCameraView, views.front().session, config);
  for (const CameraView& view : views) publisher.publish(view);
  publisher.flush();
}

}  // namespace kintsugi::segmenter::testing

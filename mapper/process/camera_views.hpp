#pragma once

#include <cstdint>
#include <optional>

#include "lcmtypes/messages.hpp"
#include "mapper/core/frame/rgbd_frame.hpp"
#include "mapper/core/tracking/tracking_result.hpp"

namespace kintsugi::mapper {

/// What the camera sees, at a small size and a few times a second.
class CameraViews {
 public:
  /// @param rate_hz of views, in device time; 0: none
  explicit CameraViews(double rate_hz) : rate_hz_(rate_hz) {}

  /// The view of a frame, without session and name of the map; nothing: none is due.
  std::optional<CameraView> next(const RgbdFrame& frame, const TrackingResult& tracking);

 private:
  const double rate_hz_;
  std::optional<std::int64_t> last_utime_;
};

/// `frame` at a small size: depth of about 160 pixels a row, colour of about 320.
CameraView make_camera_view(const RgbdFrame& frame, const TrackingResult& tracking);

}  // namespace kintsugi::mapper

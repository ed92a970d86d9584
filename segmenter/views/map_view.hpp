#pragma once
// What the camera measured at one moment, at a small size: evidence of where there is free space.

#include <cstdint>
#include <vector>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::segmenter {

struct MapView {
  std::int64_t utime = 0;               ///< of the frame, device time, microseconds
  Pose X_WC = Pose::Identity();         ///< as the map is corrected now
  Intrinsics intrinsics;                ///< of the small depth image, pixels
  std::vector<std::uint16_t> depth_mm;  ///< along C's z, row after row; 0: not measured

  bool operator==(const MapView& other) const {
    return utime == other.utime && X_WC.matrix() == other.X_WC.matrix() &&
           intrinsics == other.intrinsics && depth_mm == other.depth_mm;
  }
};

}  // namespace kintsugi::segmenter

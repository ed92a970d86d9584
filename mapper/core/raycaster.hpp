#pragma once

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/surface_map.hpp"

namespace kintsugi::mapper {

class TsdfVolume;

/// The surface of the volume as a camera would see it.
class Raycaster {
 public:
  struct Config {
    double min_depth_m = 0.3;  ///< rays start here at the earliest
    double max_depth_m = 6.0;  ///< and end here

    /// @throws std::invalid_argument naming the field, its value and the bound.
    void validate() const;
  };

  explicit Raycaster(const Config& config);

  /// Depths and normals in C of the first crossing from free space into a surface along each
  /// pixel's ray, at the resolution of `intrinsics` (no distortion). A pixel without one is NaN in
  /// both; a pixel whose gradient does not face the camera has a depth only.
  ///
  /// `guide_depth_m`: empty, or a depth image of the same field of view and any size; a ray starts
  /// two truncation distances before the guide's depth, which is faster and gives the same surface
  /// where the volume agrees with the guide; where it does not, the whole ray is searched.
  /// `color_rgb`: null, or where to put the surface's colour; pixels without a point are black.
  /// @throws std::invalid_argument where the intrinsics or the pose are unusable.
  SurfaceMap raycast(const TsdfVolume& volume, const Pose& X_WC, const Intrinsics& intrinsics,
                     const cv::Mat_<float>& guide_depth_m = {},
                     cv::Mat_<cv::Vec3b>* color_rgb = nullptr) const;

 private:
  Config config_;
};

}  // namespace kintsugi::mapper

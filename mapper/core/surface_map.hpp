#pragma once

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::mapper {

/// An image of surface points and normals, from a depth image or by raycasting the volume.
struct SurfaceMap {
  Intrinsics intrinsics;
  cv::Mat_<cv::Vec3f> points_C;   ///< height x width, metres; invalid is (NaN, NaN, NaN)
  cv::Mat_<cv::Vec3f> normals_C;  ///< height x width, unit, towards the camera; invalid is NaN
};

}  // namespace kintsugi::mapper

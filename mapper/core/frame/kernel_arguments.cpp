#include "mapper/core/frame/kernel_arguments.hpp"

#include <algorithm>
#include <cassert>

#include "mapper/core/frame/camera.hpp"

namespace kintsugi::mapper {
namespace {

template <typename Number, typename Surface>
Planes<Number> planes(Surface& surface) {
  assert(surface.depth_m.isContinuous() && surface.normal_x.isContinuous() &&
         surface.normal_y.isContinuous() && surface.normal_z.isContinuous());
  return {.depth_m = surface.depth_m[0],
          .normal_x = surface.normal_x[0],
          .normal_y = surface.normal_y[0],
          .normal_z = surface.normal_z[0],
          .camera = pinhole_camera(surface.intrinsics)};
}

}  // namespace

SurfacePlanes planes_of(const SurfaceMap& surface) { return planes<const float>(surface); }

MutableSurfacePlanes planes_of(SurfaceMap& surface) { return planes<float>(surface); }

RigidMotion rigid_motion(const Pose& X_BA) {
  RigidMotion motion;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) motion.R[i][j] = static_cast<float>(X_BA.linear()(i, j));
    motion.t[i] = static_cast<float>(X_BA.translation()(i));
  }
  return motion;
}

DepthVariance depth_variance(const DepthNoise& noise) {
  return {{static_cast<float>(noise.base_m * noise.base_m),
           static_cast<float>(noise.share * noise.share),
           static_cast<float>(noise.growth_per_m * noise.growth_per_m)}};
}

DepthTolerance depth_tolerance(const DepthNoise& local_noise, const Intrinsics& intrinsics) {
  const double focal_length_px = std::min(intrinsics.fx, intrinsics.fy);
  return {.variance = depth_variance(local_noise),
          .slope = DepthTolerance::kSlope / static_cast<float>(focal_length_px)};
}

}  // namespace kintsugi::mapper

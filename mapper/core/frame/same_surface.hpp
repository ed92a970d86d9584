#pragma once

#include <cmath>
#include <numbers>

#include "mapper/core/kernels/surface.hpp"

namespace kintsugi::mapper {

/// What DepthTolerance allows between depths that are `steps` pixels apart, metres: the scalar form
/// of what the kernels compute.
inline float same_surface_m(const DepthTolerance& tolerance, float depth_m, int steps) {
  const float squared = depth_m * depth_m;
  const float* c = tolerance.variance.c;
  return DepthTolerance::kSigmas * std::numbers::sqrt2_v<float> *
             std::sqrt(c[0] + squared * (c[1] + squared * c[2])) +
         tolerance.slope * static_cast<float>(steps) * depth_m;
}

}  // namespace kintsugi::mapper

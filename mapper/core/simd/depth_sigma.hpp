#pragma once

#include "mapper/core/kernels/depth_variance.hpp"

namespace kintsugi::mapper {

/// Standard deviation of sixteen depths, metres.
template <typename Float>
Float depth_sigma_m(const DepthVariance& variance, const Float& depth_m) {
  const Float squared = depth_m * depth_m;
  return sqrt(Float(variance.c[0]) +
              squared * (Float(variance.c[1]) + squared * Float(variance.c[2])));
}

}  // namespace kintsugi::mapper

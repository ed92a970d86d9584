#pragma once

namespace kintsugi::mapper {

/// DepthNoise for kernels: the variance of a depth z is c[0] + c[1] z^2 + c[2] z^4, m^2.
struct DepthVariance {
  float c[3] = {};
};

}  // namespace kintsugi::mapper

#include <cmath>

#include <gtest/gtest.h>

#include "mapper/core/frame/depth_noise.hpp"

namespace kintsugi::mapper {
namespace {

TEST(DepthNoise, AddsTheVariancesOfItsThreeErrors) {
  const DepthNoise noise{.base_m = 0.03, .share = 0.02, .growth_per_m = 0.03};
  // At 2 m: 30 mm, 40 mm and 120 mm.
  EXPECT_DOUBLE_EQ(noise.sigma_m(2.0), 0.13);
  EXPECT_DOUBLE_EQ(noise.variance_m2(2.0), 0.0169);
}

TEST(DepthNoise, IsByDefaultWithinAMillimetreOfStructuredLight) {
  for (double z_m = 0.4; z_m <= 5.0; z_m += 0.1) {
    const double nguyen_m = 0.0012 + 0.0019 * (z_m - 0.4) * (z_m - 0.4);
    EXPECT_NEAR(DepthNoise().sigma_m(z_m), nguyen_m, 0.001) << z_m << " m";
  }
}

}  // namespace
}  // namespace kintsugi::mapper

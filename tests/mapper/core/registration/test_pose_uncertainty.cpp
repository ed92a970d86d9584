#include <cmath>

#include <gtest/gtest.h>

#include "mapper/core/registration/pose_uncertainty.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kPixels = static_cast<int>(kIndependentPatches);  // each its own patch

TEST(PoseUncertainty, IsThatOfTheWorstDirectionOneMetreAhead) {
  // Camera known to 1 mm along each axis, turned by up to 2, 3 and 0 mrad: 1 m ahead that is
  // sqrt(1 + 3^2) mm; turning about the view's axis moves nothing there.
  Vector6d sigma;
  sigma << 1e-3, 1e-3, 1e-3, 2e-3, 3e-3, 9e-3;
  const Matrix6d A = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  EXPECT_NEAR(pose_sigma_m(A, Pose::Identity(), kPixels), std::sqrt(10.0) * 1e-3, 1e-9);
}

TEST(PoseUncertainty, DoesNotShrinkWithTheNumberOfPixelsAlone) {
  const Matrix6d A = 1e6 * Matrix6d::Identity();
  EXPECT_NEAR(pose_sigma_m(4.0 * A, Pose::Identity(), 4 * kPixels),
              pose_sigma_m(A, Pose::Identity(), kPixels), 1e-12);
}

TEST(PoseUncertainty, IsInfiniteWhereADirectionIsOpen) {
  Matrix6d A = 1e6 * Matrix6d::Identity();
  A(0, 0) = 0.0;
  EXPECT_TRUE(std::isinf(pose_sigma_m(A, Pose::Identity(), kPixels)));
}

}  // namespace
}  // namespace kintsugi::mapper

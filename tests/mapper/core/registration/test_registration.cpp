#include <stdexcept>

#include <gtest/gtest.h>

#include "mapper/core/registration/registration.hpp"
#include "tests/mapper/core/box_room.hpp"

namespace kintsugi::mapper {
namespace {

using testing::angle_rad;
using testing::distance_m;

constexpr int kLevels = 3;
constexpr DepthNoise kNoise{.base_m = 0.002, .share = 0.0, .growth_per_m = 0.0};

/// The room, in which everything in a thirtieth of the view, at its left, stands before its true
/// place: by 30 deviations of the depth along the rays, on slanted walls by less, always within the
/// gates.
Model with_a_strip_in_a_wrong_place(const Pose& X_WV) {
  SurfaceMap surface = testing::render_room(X_WV, testing::test_camera());
  cv::Mat strip = surface.depth_m.colRange(0, surface.depth_m.cols / 30);
  strip -= 30.0 * kNoise.base_m;
  return {pyramid_from_surface(surface, kLevels), X_WV};
}

TEST(Registration, IsNotDrawnByAStripOfTheModelInAWrongPlace) {
  const Pose X_WV = testing::looking_at_the_crate();
  const Model model = with_a_strip_in_a_wrong_place(X_WV);
  Vector6d motion;
  motion << 0.015, -0.01, 0.01, 0.01, -0.01, 0.005;
  const Pose X_WC = X_WV * se3_retract(motion);
  const Intrinsics camera = testing::test_camera();
  const TrackingInput frame{0,
                            pyramid_from_depth(testing::render_depth(X_WC, camera), camera, 0,
                                               kLevels, 10.0F, {kNoise, kNoise}),
                            {}};

  const Registration limited = register_frame(frame, model, {}, X_WV, {});
  RegistrationConfig without_limits;
  without_limits.influence = {.full_sigmas = 1e5, .none_sigmas = 1e6};
  const Registration drawn = register_frame(frame, model, {}, X_WV, without_limits);
  ASSERT_TRUE(limited.quality.solved);
  // Without the strip the data are exact: what remains is where registration stops.
  EXPECT_LT(distance_m(limited.X_WC, X_WC), 1e-4);
  EXPECT_LT(angle_rad(limited.X_WC, X_WC), 1e-4);
  EXPECT_GT(distance_m(drawn.X_WC, X_WC), 5e-3);
  // Limits change the pose, not the pairs: the strip still counts as inliers that do not fit.
  EXPECT_GT(limited.quality.rms_sigmas, 1.0);
}

TEST(Registration, RefusesLimitsInTheWrongOrder) {
  RegistrationConfig config;
  EXPECT_NO_THROW(config.validate());
  config.influence = {.full_sigmas = 3.0, .none_sigmas = 3.0};
  EXPECT_THROW(config.validate(), std::invalid_argument);
  config.influence = {.full_sigmas = 0.0, .none_sigmas = 9.0};
  EXPECT_THROW(config.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper

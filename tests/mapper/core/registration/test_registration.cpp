#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include "mapper/core/registration/registration.hpp"
#include "tests/mapper/core/boxes_before_wall.hpp"

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

constexpr double kExact_m = 1e-4;

TrackingInput frame_of(const SurfaceMap& surface_C) {
  return {0, pyramid_from_surface(surface_C, kLevels), {}};
}

/// The next slat is within the gate, and draws the pose to where the camera has passed one.
TEST(Registration, IsNotDrawnToTheNextSlatFromAPoseThatIsHardlyOff) {
  const Pose X_WV = Pose::Identity();
  const Model model{pyramid_from_surface(testing::render_slats(X_WV), kLevels), X_WV};
  const Pose X_WC = testing::gone_on_before_slats();
  const TrackingInput frame{0,
                            pyramid_from_depth(testing::render_slats(X_WC).depth_m,
                                               testing::test_camera(), 0, kLevels, 10.0F),
                            {}};
  const Registration drawn = register_frame(frame, model, {}, X_WV, {});
  EXPECT_GT(distance_m(drawn.X_WC, X_WC), 0.05) << "or else this tests nothing";
  const Registration closely = register_frame_closely(frame, model, {}, X_WV, {});
  EXPECT_LT(distance_m(closely.X_WC, X_WC), 1e-3);
  EXPECT_LT(angle_rad(closely.X_WC, X_WC), 1e-3);
  EXPECT_GT(closely.quality.support(), drawn.quality.support());
}

/// The camera was expected to go on turning, and turned back.
TEST(Registration, GoesOnFromTheStartThatFits) {
  const Pose X_WV = testing::looking_at_the_crate();
  const Intrinsics camera = testing::test_camera();
  const Model model{pyramid_from_surface(testing::render_room(X_WV, camera), kLevels), X_WV};
  const auto turned = [&](double angle_rad) {
    Vector6d turn = Vector6d::Zero();
    turn(4) = angle_rad;
    return Pose(X_WV * se3_retract(turn));
  };
  const Pose X_WC = turned(-0.1);
  const Pose X_WC_expected = turned(0.3);
  const TrackingInput frame = frame_of(testing::render_room(X_WC, camera));
  const Registration from_there = register_frame(frame, model, {}, X_WC_expected, {});
  EXPECT_GT(distance_m(from_there.X_WC, X_WC), 0.1) << "or else this tests nothing";
  for (const auto& [start, other] :
       {std::pair(X_WC_expected, X_WV), std::pair(X_WV, X_WC_expected)}) {
    const Registration found = register_frame(frame, model, {}, start, other, {});
    EXPECT_LT(distance_m(found.X_WC, X_WC), kExact_m);
    EXPECT_LT(angle_rad(found.X_WC, X_WC), kExact_m);
  }
}

/// Before a bare wall a camera fits as well where it was as where it is expected.
TEST(Registration, StaysAtTheFirstStartAlongWhatNothingDetermines) {
  const Intrinsics camera = testing::test_camera();
  SurfaceMap wall = testing::render_room(testing::looking_at_the_crate(), camera);
  wall.depth_m.setTo(2.0F);
  wall = pyramid_from_depth(wall.depth_m, camera, 0, 1, 10.0F).front();
  const Pose X_WV = Pose::Identity();
  const Model model{pyramid_from_surface(wall, kLevels), X_WV};
  const Pose X_WC_expected(Eigen::Translation3d(0.05, 0.03, 0.01));
  const Registration found = register_frame(frame_of(wall), model, {}, X_WC_expected, X_WV, {});
  EXPECT_LT((found.X_WC.translation() - Eigen::Vector3d(0.05, 0.03, 0.0)).norm(), 1e-3);
  EXPECT_EQ(found.quality.undetermined, 3);
}

/// The crate and the walls beside it, few pixels of the view, say where the camera is along the
/// wall behind.
TEST(Registration, SearchesWidelyAlongTheWall) {
  const Pose X_WV = testing::looking_at_the_crate();
  const Intrinsics camera = testing::test_camera();
  const Model model{pyramid_from_surface(testing::render_room(X_WV, camera), kLevels), X_WV};
  for (const double along_m : {-0.3, 0.3}) {
    const Pose X_WC = X_WV * Eigen::Translation3d(along_m, 0.0, 0.0);
    const TrackingInput frame = frame_of(testing::render_room(X_WC, camera));
    const Registration nearby = register_frame(frame, model, {}, X_WV, {});
    EXPECT_GT(distance_m(nearby.X_WC, X_WC), 0.1) << "or else this tests nothing";
    const Registration found = register_frame_widely(frame, model, {}, X_WV, {});
    EXPECT_LT(distance_m(found.X_WC, X_WC), kExact_m);
    EXPECT_LT(angle_rad(found.X_WC, X_WC), kExact_m);
    EXPECT_GT(found.quality.support(), nearby.quality.support());
  }
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

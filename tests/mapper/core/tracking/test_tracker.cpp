#include <vector>

#include <gtest/gtest.h>

#include "tests/mapper/core/boxes_before_wall.hpp"
#include "tests/mapper/core/tracking/tracked_room.hpp"

namespace kintsugi::mapper {
namespace {

using testing::angle_rad;
using testing::blank_frame;
using testing::distance_m;
using testing::frame_at;
using testing::kExactData_m;
using testing::kExactData_rad;
using testing::kFrame_us;
using testing::model_at;
using testing::twist;

std::vector<Vector6d> known_motions() {
  return {twist(0, 0, 0, 0, 0, 0), twist(0.03, -0.02, 0.02, 0, 0, 0),
          twist(0, 0, 0, 0.03, -0.03, 0.03), twist(-0.02, 0.03, 0.02, 0.02, 0.03, -0.03)};
}

TEST(Tracker, RecoversKnownMotions) {
  const Pose X_WV = testing::looking_at_the_crate();
  const Model model = model_at(X_WV);
  for (const Vector6d& motion : known_motions()) {
    Tracker tracker({});
    tracker.start_at(X_WV, frame_at(X_WV, 0), 1.0);
    const Pose X_WC_true = X_WV * se3_retract(motion);
    const TrackingResult result = tracker.track(frame_at(X_WC_true, kFrame_us), model);
    EXPECT_EQ(result.state, TrackingState::kTracking);
    EXPECT_LT(distance_m(result.X_WC, X_WC_true), kExactData_m);
    EXPECT_LT(angle_rad(result.X_WC, X_WC_true), kExactData_rad);
    EXPECT_GT(result.quality.inlier_share, 0.8);
    EXPECT_LT(
        (result.X_WC.linear() * result.X_WC.linear().transpose() - Eigen::Matrix3d::Identity())
            .norm(),
        1e-12);
  }
}

// With the frame's normals exact too there is no such pair, and what is left is where the
// iterations stop and single precision.
TEST(Tracker, RecoversKnownMotionsToATenthOfAMillimetre) {
  constexpr double kClean_m = 1e-4;
  constexpr double kClean_rad = 1e-4;
  const Pose X_WV = testing::looking_at_the_crate();
  const Model model = model_at(X_WV);
  for (const Vector6d& motion : known_motions()) {
    Tracker tracker({});
    tracker.start_at(X_WV, frame_at(X_WV, 0), 1.0);
    const Pose X_WC_true = X_WV * se3_retract(motion);
    const TrackingInput frame{kFrame_us, model_at(X_WC_true).surface_V, {}};
    const TrackingResult result = tracker.track(frame, model);
    EXPECT_LT(distance_m(result.X_WC, X_WC_true), kClean_m) << motion.transpose();
    EXPECT_LT(angle_rad(result.X_WC, X_WC_true), kClean_rad) << motion.transpose();
  }
}

TEST(Tracker, PredictsConstantVelocityAcrossMissingFrames) {
  const Pose X_W0 = testing::looking_at_the_crate();
  const Pose step = se3_retract(twist(0.01, 0.005, 0.01, 0.005, 0.01, -0.005));
  Tracker tracker({});
  tracker.start_at(X_W0, frame_at(X_W0, 0), 1.0);
  EXPECT_TRUE(tracker.predict(kFrame_us).isApprox(X_W0));  // nothing is known of its motion
  const Pose X_W1 = X_W0 * step;
  tracker.track(frame_at(X_W1, kFrame_us), model_at(X_W0));
  // Twice the twist of a step is its square up to second order: 0.015 m x 0.012 rad.
  EXPECT_LT(distance_m(tracker.predict(3 * kFrame_us), X_W1 * step * step), 2e-3);
  EXPECT_LT(angle_rad(tracker.predict(3 * kFrame_us), X_W1 * step * step), 2e-3);
  // Across a long gap it would be a guess.
  EXPECT_LT(distance_m(tracker.predict(100 * kFrame_us), X_W1), kExactData_m);
}

/// At two frames a second, from which the prediction is 0.3 rad off.
TEST(Tracker, FollowsACameraThatTurnsBack) {
  constexpr std::int64_t kHalfSecond_us = 500'000;
  const Pose X_W0 = testing::looking_at_the_crate();
  const Pose X_W1 = X_W0 * se3_retract(twist(0, 0, 0, 0, 0.15, 0));
  Tracker tracker({});
  tracker.start_at(X_W0, frame_at(X_W0, 0), 1.0);
  ASSERT_EQ(tracker.track(frame_at(X_W1, kHalfSecond_us), model_at(X_W0)).state,
            TrackingState::kTracking);
  ASSERT_GT(angle_rad(tracker.predict(2 * kHalfSecond_us), X_W0), 0.29);
  const TrackingResult back = tracker.track(frame_at(X_W0, 2 * kHalfSecond_us), model_at(X_W1));
  EXPECT_EQ(back.state, TrackingState::kTracking);
  EXPECT_FALSE(back.first_loss_reason);
  EXPECT_LT(distance_m(back.X_WC, X_W0), kExactData_m);
}

/// At two frames a second; from where the camera was, registration ends 34 mm off and fits well
/// enough to be accepted. First the motion is unknown; after a frame at rest it is known, and only
/// the fit is unusual.
TEST(Tracker, PrefersThePoseThatFitsBetter) {
  constexpr std::int64_t kHalfSecond_us = 500'000;
  const Pose X_WV = testing::looking_at_the_crate();
  const Model model = model_at(X_WV);
  const Pose X_WC = X_WV * se3_retract(twist(0, 0, 0, 0, 0, 0.3));
  const Registration nearby = register_frame(frame_at(X_WC, 0), model, {}, X_WV, {});
  ASSERT_GT(distance_m(nearby.X_WC, X_WC), 0.03) << "or else this tests nothing";
  for (const int frames_at_rest : {0, 1}) {
    Tracker tracker({});
    tracker.start_at(X_WV, frame_at(X_WV, 0), 1.0);
    for (int i = 1; i <= frames_at_rest; ++i)
      tracker.track(frame_at(X_WV, i * kHalfSecond_us), model);
    const std::int64_t utime = (frames_at_rest + 1) * kHalfSecond_us;
    const TrackingResult result = tracker.track(frame_at(X_WC, utime), model);
    EXPECT_EQ(result.state, TrackingState::kTracking);
    EXPECT_FALSE(result.first_loss_reason) << "the first pose was accepted, too";
    EXPECT_LT(distance_m(result.X_WC, X_WC), kExactData_m) << frames_at_rest;
  }
}

/// Slats look alike. The next one is within the gate and draws the pose away, and a wide search
/// finds no better one.
TEST(Tracker, DoesNotPassASlatWhereTheMotionSaysOtherwise) {
  const Pose X_WV = Pose::Identity();
  const Pose X_WC = testing::gone_on_before_slats();
  const auto frame_before_slats = [](const Pose& X_WC, std::int64_t utime) {
    const cv::Mat_<float> depth_m = testing::render_slats(X_WC).depth_m;
    return TrackingInput{
        utime, pyramid_from_depth(depth_m, testing::test_camera(), 0, 3, 10.0F), {}};
  };
  const Model model{pyramid_from_surface(testing::render_slats(X_WV), 3), X_WV};
  const TrackingInput frame = frame_before_slats(X_WC, 2 * kFrame_us);
  for (const Registration& drawn : {register_frame(frame, model, {}, X_WV, {}),
                                    register_frame_widely(frame, model, {}, X_WV, {})}) {
    ASSERT_GT(distance_m(drawn.X_WC, X_WC), 0.05) << "or else this tests nothing";
  }
  Tracker tracker({});
  tracker.start_at(X_WV, frame_before_slats(X_WV, 0), 1.0);
  const Pose X_WC_before = testing::gone_on_before_slats(0.1);
  ASSERT_EQ(tracker.track(frame_before_slats(X_WC_before, kFrame_us), model).state,
            TrackingState::kTracking);
  const TrackingResult result = tracker.track(frame, model);
  EXPECT_EQ(result.state, TrackingState::kTracking);
  EXPECT_LT(distance_m(result.X_WC, X_WC), 1e-3);
}

/// A pose that fits better is of another place if the camera cannot have got there.
TEST(Tracker, IsLostWhereTheCameraCannotHaveGot) {
  const Pose X_WV = testing::looking_at_the_crate();
  const Model model = model_at(X_WV);
  const Pose X_WC = X_WV * se3_retract(twist(0.3, 0, 0, 0, 0, 0));
  for (const std::int64_t gap_us : {kFrame_us, 10 * kFrame_us}) {
    Tracker tracker({});
    tracker.start_at(X_WV, frame_at(X_WV, 0), 1.0);
    const bool can_have_got_there = gap_us > kFrame_us;
    const TrackingResult result = tracker.track(frame_at(X_WC, gap_us), model);
    EXPECT_EQ(result.state == TrackingState::kTracking, can_have_got_there);
    EXPECT_TRUE(result.first_loss_reason);
  }
}

TEST(Tracker, KnowsWhereTheCameraCanHaveGot) {
  const Pose X_W0 = testing::looking_at_the_crate();
  const auto metres_away = [&](double x) { return X_W0 * se3_retract(twist(x, 0, 0, 0, 0, 0)); };
  Tracker tracker({});
  EXPECT_TRUE(tracker.can_be_at(metres_away(1000.0), 0, 0.0)) << "before the first pose";
  tracker.start_at(X_W0, frame_at(X_W0, 0), 1.0);
  EXPECT_TRUE(tracker.can_be_at(metres_away(0.15), 100'000, 0.0)) << "at 2 m/s";
  EXPECT_FALSE(tracker.can_be_at(metres_away(0.3), 100'000, 0.0));
  EXPECT_TRUE(tracker.can_be_at(metres_away(0.3), 200'000, 0.0));
  EXPECT_TRUE(tracker.can_be_at(metres_away(0.3), 100'000, 10.0)) << "after a drift of 2 %";
  EXPECT_TRUE(tracker.can_be_at(metres_away(0.5), 100'000, 0.0, 0.3)) << "near to it";
  EXPECT_FALSE(tracker.can_be_at(metres_away(0.6), 100'000, 0.0, 0.3));
}

TEST(Tracker, IsLostOnABlankFrameAndRecoversWhenTheViewReturns) {
  const Pose X_WV = testing::looking_at_the_crate();
  const Model model = model_at(X_WV);
  Tracker tracker({});
  tracker.start_at(X_WV, frame_at(X_WV, 0), 1.0);
  for (int i = 1; i <= 5; ++i) {
    const TrackingResult result = tracker.track(blank_frame(i * kFrame_us), model);
    EXPECT_EQ(result.state, TrackingState::kLost);
    EXPECT_EQ(result.loss_reason, LossReason::kTooFewPixels);
    EXPECT_TRUE(result.X_WC.isApprox(X_WV));
  }
  const Pose X_WC_true = X_WV * se3_retract(twist(0.04, 0.0, 0.03, 0.0, 0.03, 0.0));
  const TrackingResult result = tracker.track(frame_at(X_WC_true, 6 * kFrame_us), model);
  EXPECT_EQ(result.state, TrackingState::kTracking);
  EXPECT_LT(distance_m(result.X_WC, X_WC_true), kExactData_m);
}

TEST(Tracker, DoesNotBelieveAViewOfSomethingElse) {
  const Pose X_WV = testing::looking_at_the_crate();
  Tracker tracker({});
  tracker.start_at(X_WV, frame_at(X_WV, 0), 1.0);
  const Model model = model_at(X_WV);
  for (int i = 1; i <= 12; ++i) tracker.track(frame_at(X_WV, i * kFrame_us), model);
  const Pose about_face = X_WV * se3_retract(twist(0.4, 0.3, 0.5, 0.0, 1.2, 0.4));
  const TrackingResult result = tracker.track(frame_at(about_face, 13 * kFrame_us), model);
  EXPECT_EQ(result.state, TrackingState::kLost);
  EXPECT_TRUE(result.X_WC.isApprox(X_WV, 1e-3));
}

TEST(TrackerConfig, NamesTheFieldOutOfRange) {
  Tracker::Config config;
  config.registration.gates.max_distance_m = -1.0;
  EXPECT_THROW(Tracker{config}, std::invalid_argument);
  config = {};
  config.registration.iterations = {};
  EXPECT_THROW(Tracker{config}, std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper

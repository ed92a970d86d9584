// The tracker after a loss: where it expects the camera, and when it gives up.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/mapper/core/tracking/tracked_room.hpp"

namespace kintsugi::mapper {
namespace {

using testing::blank_frame;
using testing::distance_m;
using testing::frame_at;
using testing::kExactData_m;
using testing::kFrame_us;
using testing::model_at;
using testing::twist;

/// A tracker that has followed some frames of a camera with constant velocity; the model is exact.
class Motion {
 public:
  explicit Motion(const Tracker::Config& config = {}) : tracker(config) {
    tracker.start_at(X_WC(0), frame_at(X_WC(0), 0), 1.0);
    for (int i = 1; i <= kSeen; ++i) {
      EXPECT_EQ(show(frame_at(X_WC(i), i * kFrame_us), i).state, TrackingState::kTracking);
    }
  }
  /// With the model seen from where the camera is expected.
  TrackingResult show(const TrackingInput& frame, int i) {
    return tracker.track(frame, model_at(tracker.predict(i * kFrame_us)));
  }
  Pose X_WC(int i) const { return X_W0_ * se3_retract(i * step_); }

  static constexpr int kSeen = 3;
  Tracker tracker;

 private:
  Pose X_W0_ = testing::looking_at_the_crate();
  Vector6d step_ = twist(0.01, 0.005, -0.01, 0.0, 0.01, 0.0);
};

/// Poses and velocities of exact data, over a few frames.
constexpr double kCoasted_m = 0.005;

TEST(Coasting, ExpectsALostCameraToGoOnForAWhile) {
  Motion motion;
  Tracker& tracker = motion.tracker;
  EXPECT_FALSE(tracker.is_coasting((Motion::kSeen + 1) * kFrame_us)) << "it is not lost";
  const Pose X_W_last = motion.X_WC(Motion::kSeen);
  const std::int64_t coast_us = Tracker::Config().coast_us;
  for (int i = Motion::kSeen + 1; i <= Motion::kSeen + 12; ++i) {
    const std::int64_t utime = i * kFrame_us;
    const bool coasts = utime - Motion::kSeen * kFrame_us <= coast_us;
    EXPECT_LT(distance_m(tracker.predict(utime), coasts ? motion.X_WC(i) : X_W_last), kCoasted_m);
    const TrackingResult result = motion.show(blank_frame(utime), i);
    EXPECT_EQ(result.state, TrackingState::kLost);
    EXPECT_LT(distance_m(result.X_WC, X_W_last), kExactData_m) << "the last good pose stays";
    EXPECT_EQ(tracker.is_coasting(utime), coasts) << i;
  }
}

/// Somebody's arm in a quarter of the view: enough to doubt a pose found anew, not one that goes on
/// with the camera's motion.
TrackingInput with_an_arm(const Pose& X_WC, std::int64_t utime) {
  const Intrinsics camera = testing::test_camera();
  cv::Mat_<float> depth_m = testing::render_depth(X_WC, camera);
  depth_m.colRange(0, camera.width / 4).setTo(0.6F);
  return {utime, pyramid_from_depth(depth_m, camera, 0, 3, 10.0F), {}};
}

TEST(Coasting, GoesOnWithItsMotionAfterALostFrame) {
  Tracker::Config no_coasting;
  no_coasting.coast_us = 0;
  for (const Tracker::Config& config : {Tracker::Config(), no_coasting}) {
    const bool coasts = config.coast_us > 0;
    Motion motion(config);
    int i = Motion::kSeen + 1;
    EXPECT_EQ(motion.show(blank_frame(i * kFrame_us), i).state, TrackingState::kLost);
    ++i;
    const TrackingResult result = motion.show(with_an_arm(motion.X_WC(i), i * kFrame_us), i);
    EXPECT_EQ(result.state, coasts ? TrackingState::kTracking : TrackingState::kLost);
    if (!coasts) continue;
    EXPECT_LT(distance_m(result.X_WC, motion.X_WC(i)), kCoasted_m);
    // The velocity is known on.
    EXPECT_LT(distance_m(motion.tracker.predict((i + 2) * kFrame_us), motion.X_WC(i + 2)),
              kCoasted_m);
  }
}

/// A part of space that the map does not have.
Model nothing_at(const Pose& X_WV) {
  SurfaceMap nothing(testing::test_camera());
  for (cv::Mat* plane :
       {&nothing.depth_m, &nothing.normal_x, &nothing.normal_y, &nothing.normal_z}) {
    plane->setTo(std::nanf(""));
  }
  return {pyramid_from_surface(nothing, 3), X_WV};
}

TEST(Coasting, FollowsFromFrameToFrameWhereTheMapIsMissing) {
  Motion motion;
  const Pose X_W_last = motion.X_WC(Motion::kSeen);
  const Vector6d other_step = twist(-0.005, 0.0, 0.01, 0.01, 0.0, -0.005);
  // Twice as long as it would coast, and with another velocity.
  for (int i = 1; i <= 20; ++i) {
    const std::int64_t utime = (Motion::kSeen + i) * kFrame_us;
    const Pose X_WC = X_W_last * se3_retract(i * other_step);
    const TrackingResult result =
        motion.tracker.track(frame_at(X_WC, utime), nothing_at(motion.tracker.predict(utime)));
    EXPECT_EQ(result.state, TrackingState::kLost);
    EXPECT_EQ(result.first_loss_reason, LossReason::kNotSolved);
    EXPECT_LT(distance_m(result.X_WC, X_W_last), kExactData_m) << "the last good pose stays";
    EXPECT_TRUE(motion.tracker.is_coasting(utime)) << i;
    EXPECT_LT(distance_m(motion.tracker.predict(utime), X_WC), 2.0 * kCoasted_m) << i;
  }
  // The map again, from where the camera is now.
  const std::int64_t utime = (Motion::kSeen + 21) * kFrame_us;
  const Pose X_WC = X_W_last * se3_retract(21 * other_step);
  const TrackingResult result =
      motion.tracker.track(frame_at(X_WC, utime), model_at(motion.tracker.predict(utime)));
  EXPECT_EQ(result.state, TrackingState::kTracking);
  EXPECT_LT(distance_m(result.X_WC, X_WC), kExactData_m);
}

TEST(Coasting, TellsWhyThePoseThatContinuesTheMotionWasRejected) {
  Motion motion;
  const int i = Motion::kSeen + 1;
  const TrackingResult good = motion.show(frame_at(motion.X_WC(i), i * kFrame_us), i);
  EXPECT_FALSE(good.first_loss_reason);
  const TrackingResult lost = motion.show(blank_frame((i + 1) * kFrame_us), i + 1);
  EXPECT_EQ(lost.first_loss_reason, LossReason::kTooFewPixels);
}

/// A wall at this distance ahead.
TrackingInput wall_at(double distance_m, std::int64_t utime) {
  const Intrinsics camera = testing::test_camera();
  const cv::Mat_<float> depth_m(camera.height, camera.width, static_cast<float>(distance_m));
  return {utime, pyramid_from_depth(depth_m, camera, 0, 3, 10.0F), {}};
}

TEST(Coasting, FollowsWhatIsDeterminedOfTheMotionWithoutAcceptingIt) {
  constexpr double kWall_m = 2.0;
  constexpr double kStep_m = 0.01;
  Tracker tracker({});
  tracker.start_at(Pose::Identity(), wall_at(kWall_m, 0), 1.0);
  const std::int64_t coast_partly_us = Tracker::Config().coast_partly_us;
  bool has_given_up = false;
  for (int i = 1; i <= 50; ++i) {
    const std::int64_t utime = i * kFrame_us;
    const double along_m = i * kStep_m;
    const Pose X_WV = tracker.predict(utime);
    const Model model{
        pyramid_from_surface(wall_at(kWall_m - X_WV.translation().z(), 0).surface_C.front(), 3),
        X_WV};
    const TrackingResult result = tracker.track(wall_at(kWall_m - along_m, utime), model);
    EXPECT_EQ(result.state, TrackingState::kLost) << i;
    EXPECT_TRUE(result.X_WC.isApprox(Pose::Identity())) << i;
    if (utime <= coast_partly_us) {
      EXPECT_EQ(result.first_loss_reason, LossReason::kUndetermined) << i;
      EXPECT_TRUE(tracker.is_coasting(utime)) << i;
      Pose X_WC_true = Pose::Identity();
      X_WC_true.translation().z() = along_m;
      // Along the wall and about its normal the prediction stays.
      EXPECT_LT(distance_m(tracker.predict(utime), X_WC_true), kExactData_m) << i;
    } else {
      has_given_up = true;
      EXPECT_FALSE(tracker.is_coasting(utime)) << i;
      EXPECT_TRUE(tracker.predict(utime).isApprox(Pose::Identity())) << i;
    }
  }
  EXPECT_TRUE(has_given_up);
}

}  // namespace
}  // namespace kintsugi::mapper

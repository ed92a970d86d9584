// A camera that comes back to a place with some drift, and stands still there.

#include <cmath>
#include <cstdint>
#include <optional>

#include <gtest/gtest.h>

#include "mapper/core/loop_closure/loop_closure.hpp"
#include "tests/mapper/core/synthetic_frames.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kKeyframes = 8;  // of each visit
constexpr std::int64_t kSecond_us = 1'000'000;

Pose drift() {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(0.02, -0.01, 0.02);
  return X;
}

TrackingInput input_of(const RgbdFrame& frame, std::int64_t utime) {
  return {utime, pyramid_from_depth(frame.depth_m, frame.intrinsics, 0, 3, 6.0F), frame.color_rgb};
}

/// The camera comes back after a way on which it drifted.
class TwoVisits : public ::testing::Test {
 protected:
  TwoVisits() {
    const testing::SyntheticRun run = testing::synthetic_run("office", 2 * kKeyframes, true, 5);
    for (int number = 0; number < 2 * kKeyframes; ++number) {
      const bool is_back = number >= kKeyframes;
      if (number == kKeyframes) keyframes.release_if([](const Keyframe&) { return true; });
      // Frames 0, 10, 20.. for the first visit, 5, 15, 25.. for the second.
      const int i = is_back ? 2 * (number - kKeyframes) + 1 : 2 * number;
      const TrackingInput input = input_of(run.frames[i], utime);
      TrackingResult located;
      located.X_WC = (is_back ? drift() : Pose::Identity()) * run.true_path[i].X_WC;
      // 1 mm from one keyframe to the next, and 0.2 m from the first visit to the second.
      located.information_C = Matrix6d::Identity() * (number == kKeyframes ? 25.0 : 1e6);
      keyframes.add(located.X_WC, input, input.surface_C[1]);
      utime = number * kSecond_us;
      loops.follow(located, true, utime, {});
    }
  }

  const LoopClosure::Config config;
  KeyframeMap keyframes{{}};
  LoopClosure loops{config, keyframes};
  std::int64_t utime = 0;
};

TEST_F(TwoVisits, AreCorrectedInTimeAlsoIfNoKeyframeFollows) {
  const auto correction = loops.take_due(utime + std::llround(1e6 * config.closer.delay_s));
  ASSERT_TRUE(correction);
  EXPECT_EQ(correction->X_WK.size(), 2U * kKeyframes) << "with what the last keyframe brought";
}

TEST_F(TwoVisits, AreWhereTheSurfaceOfTheFirstFindsTheCameraOfTheSecond) {
  constexpr int kFirst = 3;
  constexpr int kSecond = 2 * kKeyframes - 1;
  const auto before = loops.finish();
  ASSERT_TRUE(before);
  Pose X_FC = before->X_WK[kFirst].inverse() * before->X_WK[kSecond];
  X_FC.translation() += Eigen::Vector3d(0.03, 0.0, 0.0);
  TrackingResult found;
  found.X_WC = keyframes[kFirst].X_WC * X_FC;
  found.information_C = Matrix6d::Identity() * 1e6;
  found.quality.sigma_m = 0.001;
  loops.measure_anew(kFirst, found, keyframes[kSecond].X_WC, utime);
  const auto after = loops.finish();
  ASSERT_TRUE(after);
  const Pose left = X_FC.inverse() * after->X_WK[kFirst].inverse() * after->X_WK[kSecond];
  EXPECT_LT(left.translation().norm(), 0.005);
}

TEST(LoopClosure, CountsTheWayToAKeyframeAndNotHowFarTheCameraHasGone) {
  const TrackingInput input = input_of(testing::synthetic_run("office", 2, true, 5).frames[0], 0);
  KeyframeMap keyframes{{}};
  LoopClosure loops({}, keyframes);
  std::int64_t utime = 0;
  const auto go_to = [&](double x_m, bool is_keyframe) {
    TrackingResult located;
    located.X_WC.translation().x() = x_m;
    if (is_keyframe) keyframes.add(located.X_WC, input, input.surface_C[1]);
    loops.follow(located, is_keyframe, ++utime, {});
  };
  go_to(0.0, true);
  for (const double x_m : {0.3, 0.6, 0.9}) go_to(x_m, false);
  go_to(1.0, true);
  EXPECT_NEAR(loops.ways_m()[0], 1.0, 1e-9);
  for (int i = 0; i < 100; ++i) go_to(i % 2 == 0 ? 1.05 : 1.0, false);  // 5 m at the second one
  EXPECT_NEAR(loops.ways_m()[0], 1.0, 1e-9);
  EXPECT_EQ(loops.ways_m()[1], 0.0);
  go_to(1.1, false);  // still near it
  go_to(1.6, true);
  EXPECT_NEAR(loops.take_new()->way_m, 0.6, 1e-9) << "from the keyframe";
}

/// On known surface the camera gets no keyframe, for however long it goes there.
TEST(LoopClosure, BoundsTheUnseenWayFromWhereTheCameraWasLost) {
  const TrackingInput input = input_of(testing::synthetic_run("office", 2, true, 5).frames[0], 0);
  KeyframeMap keyframes{{}};
  LoopClosure::Config config;
  config.max_speed = 2.0;
  LoopClosure loops(config, keyframes);
  const auto be_at = [&](double x_m, bool is_keyframe, double time_s) {
    TrackingResult located;
    located.X_WC.translation().x() = x_m;
    if (is_keyframe) keyframes.add(located.X_WC, input, input.surface_C[1]);
    loops.follow(located, is_keyframe, std::llround(1e6 * time_s), {});
  };
  be_at(0.0, true, 0.0);
  be_at(1.0, true, 1.0);
  EXPECT_FALSE(loops.take_new()->unseen);
  be_at(0.1, false, 3'600.0);
  loops.begin_part();
  be_at(1'000.0, true, 3'607.0);
  const auto unseen = loops.take_new()->unseen;
  ASSERT_TRUE(unseen);
  EXPECT_EQ(unseen->before, 1);
  EXPECT_NEAR(unseen->distance_m, 0.9 + 2.0 * 7.0, 1e-6);
}

}  // namespace
}  // namespace kintsugi::mapper

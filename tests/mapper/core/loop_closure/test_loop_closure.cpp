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

TEST(LoopClosure, CorrectsInTimeAlsoIfNoKeyframeFollows) {
  const testing::SyntheticRun run = testing::synthetic_run("office", 2 * kKeyframes, true, 5);
  const LoopClosure::Config config;
  KeyframeMap keyframes{{}};
  LoopClosure loops(config, keyframes);
  std::int64_t utime = 0;
  for (int number = 0; number < 2 * kKeyframes; ++number) {
    const bool is_back = number >= kKeyframes;
    if (number == kKeyframes) keyframes.release_if([](const Keyframe&) { return true; });
    // Frames 0, 10, 20.. for the first visit, 5, 15, 25.. for the second.
    const int i = is_back ? 2 * (number - kKeyframes) + 1 : 2 * number;
    const RgbdFrame& frame = run.frames[i];
    const TrackingInput input{
        utime, pyramid_from_depth(frame.depth_m, frame.intrinsics, 0, 3, 6.0F), frame.color_rgb};
    TrackingResult located;
    located.X_WC = (is_back ? drift() : Pose::Identity()) * run.true_path[i].X_WC;
    // 1 mm from one keyframe to the next, and 0.2 m from the first visit to the second.
    located.information_C = Matrix6d::Identity() * (number == kKeyframes ? 25.0 : 1e6);
    keyframes.add(located.X_WC, input, input.surface_C[1]);
    utime = number * kSecond_us;
    loops.follow(located, true, utime, {});
  }
  const auto correction = loops.take_due(utime + std::llround(1e6 * config.closer.delay_s));
  ASSERT_TRUE(correction);
  EXPECT_EQ(correction->X_WK.size(), 2U * kKeyframes) << "with what the last keyframe brought";
}

}  // namespace
}  // namespace kintsugi::mapper

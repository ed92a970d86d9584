// A camera that comes back to a place with some drift, and one that comes to another place.

#include <cmath>
#include <map>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "lcmtypes/trajectory.hpp"
#include "mapper/core/loop_closure/loop_closer.hpp"
#include "tests/mapper/core/synthetic_frames.hpp"

namespace kintsugi::mapper {
namespace {

using testing::synthetic_run;
using testing::SyntheticRun;

constexpr int kKeyframes = 8;     // of each visit
constexpr double kAway_m = 30.0;  // path between both visits
constexpr double kNear = 1e6;     // information: 1 mm from one keyframe to the next
constexpr double kAway = 25.0;    // and 0.2 m from the first visit to the second
constexpr std::int64_t kSecond_us = 1'000'000;

/// Frames 0, 10, 20.. of the scene for the first visit, 5, 15, 25.. for the second.
const SyntheticRun& run_of(const std::string& scene) {
  static std::map<std::string, SyntheticRun> runs;
  auto found = runs.find(scene);
  if (found == runs.end()) {
    found = runs.emplace(scene, synthetic_run(scene, 2 * kKeyframes, true, 5)).first;
  }
  return found->second;
}

/// Of a camera that drifts between the visits.
Pose drift() {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(0.08, -0.05, 0.1);
  X.linear() = Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return X;
}

class TwoVisits {
 public:
  TwoVisits(const std::string& first, const std::string& second, bool with_color)
      : with_color_(with_color) {
    for (int i = 0; i < kKeyframes; ++i) visit(first, 2 * i, Pose::Identity(), 0.1);
    for (int i = 0; i < kKeyframes; ++i) visit(second, 2 * i + 1, drift(), i == 0 ? kAway_m : 0.1);
  }

  std::optional<MapCorrection> finish() { return closer.drain(); }
  const Keyframe& keyframe(int number) const { return keyframes_[number]; }

  LoopCloser closer{LoopCloser::Config{}};

 private:
  void visit(const std::string& scene, int frame_number, const Pose& X_UT, double way_m) {
    const SyntheticRun& run = run_of(scene);
    const RgbdFrame& frame = run.frames[frame_number];
    TrackingInput input{
        frame.utime, pyramid_from_depth(frame.depth_m, frame.intrinsics, 0, 3, 6.0F), {}};
    if (with_color_) input.color_rgb = frame.color_rgb;
    const int number = keyframes_.size();
    keyframes_.add(X_UT * run.true_path[frame_number].X_WC, input, input.surface_C[1]);
    NewKeyframe added{.number = number,
                      .keyframe = keyframes_.share(number),
                      .from = number == 0 ? std::nullopt : std::optional(number - 1),
                      .way_m = way_m,
                      .information = Matrix6d::Identity() * (number == kKeyframes ? kAway : kNear),
                      .similar = {},
                      .is_released = {},
                      .noise = {}};
    for (int i = 0; i <= number; ++i)
      added.is_released.push_back(number >= kKeyframes && i < kKeyframes);
    added.similar = keyframes_.similar_to(number, [&](int i) { return added.is_released[i]; });
    closer.add(std::move(added), number * kSecond_us);
  }

  bool with_color_;
  KeyframeMap keyframes_{{}};
};

class LoopCloserWithAndWithoutColor : public ::testing::TestWithParam<bool> {};

TEST_P(LoopCloserWithAndWithoutColor, BringsTheSecondVisitToTheFirst) {
  TwoVisits visits("office", "office", GetParam());
  const auto correction = visits.finish();
  ASSERT_TRUE(correction);
  EXPECT_GE(correction->loops.size(), 2U);
  EXPECT_EQ(correction->num_contradicted, 0);
  ASSERT_EQ(correction->X_WK.size(), 2U * kKeyframes);
  const auto& truth = run_of("office").true_path;
  for (int i = 0; i < kKeyframes; ++i) {
    // The first keyframe stays where it is.
    const Pose error = truth[2 * i + 1].X_WC.inverse() * correction->X_WK[kKeyframes + i];
    EXPECT_LT(error.translation().norm(), 0.01) << "keyframe " << i;
    EXPECT_LT(rotation_angle_rad(error), 0.005) << "keyframe " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(LoopCloser, LoopCloserWithAndWithoutColor, ::testing::Bool());

TEST(LoopCloser, ClosesNoLoopBetweenDifferentPlaces) {
  for (const bool with_color : {false, true}) {
    EXPECT_FALSE(TwoVisits("office", "kitchen", with_color).finish()) << with_color;
    EXPECT_FALSE(TwoVisits("hallway", "hall", with_color).finish()) << with_color;
  }
}

TEST(LoopCloser, MovesTheSecondVisitToWhereAViewOfBothHasIt) {
  constexpr int kFirst = 3;
  constexpr int kSecond = kKeyframes + 3;
  TwoVisits visits("office", "office", true);
  const auto before = visits.finish();
  ASSERT_TRUE(before);
  SharedView view{.tracked_near = kSecond, .found_by = kFirst};
  view.X_FC = before->X_WK[kFirst].inverse() * before->X_WK[kSecond];
  view.X_FC.translation() += Eigen::Vector3d(0.0, 0.03, 0.0);
  view.information_C = Matrix6d::Identity() * kNear;
  view.sigma_m = 0.001;
  visits.closer.add(view, 0);
  const auto after = visits.finish();
  ASSERT_TRUE(after);
  EXPECT_EQ(after->num_contradicted, 0);
  const Pose left = view.X_FC.inverse() * after->X_WK[kFirst].inverse() * after->X_WK[kSecond];
  EXPECT_LT(left.translation().norm(), 0.005);

  TwoVisits elsewhere("office", "kitchen", true);
  elsewhere.closer.add(view, 0);
  EXPECT_FALSE(elsewhere.finish()) << "no loop was closed there";
}

TEST(LoopCloser, CorrectionsComeOutAtATimeThatDependsOnTheFramesAlone) {
  TwoVisits visits("office", "office", true);
  const std::int64_t delay_us = std::llround(1e6 * LoopCloser::Config{}.delay_s);
  std::vector<std::int64_t> due;
  const std::int64_t end_us = std::int64_t{2} * kKeyframes * kSecond_us + delay_us;
  for (std::int64_t utime = 0; utime <= end_us; utime += kSecond_us / 2) {
    if (visits.closer.take_due(utime)) due.push_back(utime);
  }
  ASSERT_FALSE(due.empty());
  for (const std::int64_t utime : due) {
    EXPECT_EQ((utime - delay_us) % kSecond_us, 0) << "that long after a keyframe";
    EXPECT_GE(utime, (kKeyframes + 1) * kSecond_us + delay_us) << "two loops are needed";
  }
}

}  // namespace
}  // namespace kintsugi::mapper

// Two parts of a map that are the same room, and loops that say so, rightly or not.

#include <gtest/gtest.h>

#include "mapper/core/loop_closure/join_rule.hpp"
#include "mapper/core/loop_closure/map_part.hpp"
#include "tests/mapper/core/synthetic_frames.hpp"

namespace kintsugi::mapper {
namespace {

using testing::synthetic_run;
using testing::SyntheticRun;

constexpr int kKeyframes = 12;  // of each part, along the path through the office
constexpr int kStep = 30;       // frames from one to the next, in the other part halfway between

class JoinRuleTest : public ::testing::Test {
 protected:
  JoinRuleTest() {
    const SyntheticRun room = synthetic_run("office", 2 * kKeyframes, true, kStep / 2);
    KeyframeMap map{{}};
    for (int part = 0; part < 2; ++part) {
      for (int i = 0; i < kKeyframes; ++i) {
        const RgbdFrame& frame = room.frames[2 * i + part];
        const TrackingInput input{frame.utime,
                                  pyramid_from_depth(frame.depth_m, frame.intrinsics, 0, 3, 6.0F),
                                  frame.color_rgb};
        truth_.push_back(room.true_path[2 * i + part].X_WC);
        const Pose X_UK = origin_of_part(part) * truth_.back();
        const int number = map.size();
        map.add(X_UK, input, input.surface_C[1]);
        map.similar_to(number, [](int) { return false; });  // waits for its appearance
        keyframes_.push_back(map.share(number));
        graph_.add(X_UK, i == 0 ? std::nullopt : std::optional(number - 1), 0.5);
      }
    }
  }

  /// Of the later part's keyframe number i with the nearest one of the earlier part, `error` off.
  Loop loop(int i, const Pose& error = Pose::Identity()) const {
    const int later = kKeyframes + i;
    return {later, i, truth_[i].inverse() * error * truth_[later], Matrix6d::Identity(), 0.003};
  }
  bool holds(const std::vector<Loop>& loops) const {
    return JoinRule({}, verifier_).holds(loops, graph_, keyframes_, DepthNoise());
  }

  std::vector<Pose> truth_;  ///< of the keyframes, in the frame of the room
  JoinRule::Keyframes keyframes_;
  KeyframeGraph graph_{{}};
  LoopVerifier verifier_{{}};
};

TEST_F(JoinRuleTest, HoldsForLoopsFromViewsThatHaveLittleInCommon) {
  EXPECT_TRUE(holds({loop(1), loop(5), loop(9)}));
}

TEST_F(JoinRuleTest, DoesNotHoldForLoopsFromOneView) {
  EXPECT_FALSE(holds({loop(5)}));
  EXPECT_FALSE(holds({loop(5), loop(5), loop(5)}));
}

TEST_F(JoinRuleTest, DoesNotHoldWhereTheOtherKeyframesDoNotSeeWhatTheyWould) {
  for (const Eigen::Vector3d& error_m :
       {Eigen::Vector3d(1.0, 0.0, 0.0), Eigen::Vector3d(0.0, -1.5, 0.0)}) {
    const Pose error(Eigen::Translation3d{error_m});
    EXPECT_FALSE(holds({loop(1, error), loop(5, error), loop(9, error)}));
  }
}

}  // namespace
}  // namespace kintsugi::mapper

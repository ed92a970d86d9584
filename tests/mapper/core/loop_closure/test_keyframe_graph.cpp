#include <optional>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/loop_closure/keyframe_graph.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kStep_m = 0.5;
constexpr double kSigma_m = 0.002;

Matrix6d precise() { return Matrix6d::Identity() / (kSigma_m * kSigma_m); }

Pose at(double x, double y = 0.0) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(x, y, 0.0);
  return pose;
}

/// Out along x and back: keyframe 2 n - i is where keyframe i was, but for a drift along y that
/// grows with the path.
class OutAndBack : public ::testing::Test {
 protected:
  static constexpr int kHalf = 20;

  OutAndBack() {
    for (int i = 0; i <= 2 * kHalf; ++i) {
      graph.add(drifted(i), i == 0 ? std::nullopt : std::optional(i - 1), kStep_m);
      if (i > 0) graph.add_tracked(i - 1, i, precise());
    }
  }
  static Pose truth(int i) { return at(kStep_m * (i <= kHalf ? i : 2 * kHalf - i)); }
  static Pose drifted(int i) { return at(truth(i).translation().x(), 0.005 * kStep_m * i); }
  static Loop loop(int later, const Pose& error = Pose::Identity()) {
    const int earlier = 2 * kHalf - later;
    return {later, earlier, truth(earlier).inverse() * truth(later) * error, precise(), kSigma_m};
  }

  KeyframeGraph graph{{}};
};

TEST_F(OutAndBack, ALoopCountsWhenAnotherOneAgreesWithIt) {
  EXPECT_EQ(graph.offer(loop(38)), 0);
  EXPECT_EQ(graph.offer(loop(40)), 2);
  EXPECT_EQ(graph.offer(loop(39)), 1);
  EXPECT_EQ(graph.loops().size(), 3U);
}

TEST_F(OutAndBack, ALoopFromTheSameKeyframeOrFarAwayConfirmsNothing) {
  graph.offer(loop(38));
  EXPECT_EQ(graph.offer(loop(38)), 0) << "one view may look like another place";
  EXPECT_EQ(graph.offer(loop(26)), 0) << "6 m of path away";
}

TEST_F(OutAndBack, LoopsThatContradictEachOtherConfirmNothing) {
  graph.offer(loop(38));
  EXPECT_EQ(graph.offer(loop(40, at(0.05))), 0);
  EXPECT_TRUE(graph.loops().empty());
}

TEST_F(OutAndBack, ALoopThatLeadsFartherThanTrackingDriftsIsRefused) {
  // The path between the keyframes is 18 and 20 m long: 2 % of it are 0.36 and 0.4 m.
  EXPECT_EQ(graph.offer(loop(38, at(0.6))), 0);
  EXPECT_EQ(graph.offer(loop(40, at(0.6))), 0);
  EXPECT_EQ(graph.offer(loop(38, at(0.2))), 0);
  EXPECT_EQ(graph.offer(loop(40, at(0.2))), 2);
}

TEST_F(OutAndBack, FromRoundToRoundTrackingDriftsNoFarther) {
  // On later rounds the camera is tracked in the surface of the first, from keyframe 10 on, and
  // comes by a place that looks like that of keyframes 2 and 3. The way there is 4 m long: 2 % of
  // it are 8 cm, however many rounds the camera has gone.
  for (int round = 1; round <= 100; ++round) {
    graph.add(drifted(10) * at(0.0, 0.1 * round), 10, kStep_m);
  }
  graph.add(drifted(11), 10, kStep_m);
  const int last = graph.size() - 1;
  const auto elsewhere = [&](int later, int earlier, double error_m) {
    const Pose X_EL = drifted(earlier).inverse() * graph.X_UK(later) * at(error_m);
    return Loop{later, earlier, X_EL, precise(), kSigma_m};
  };
  EXPECT_EQ(graph.offer(elsewhere(last, 3, 0.15)), 0);
  EXPECT_EQ(graph.offer(elsewhere(10, 2, 0.15)), 0) << "too far, though they agree";
  EXPECT_EQ(graph.offer(elsewhere(last, 3, 0.05)), 0);
  EXPECT_EQ(graph.offer(elsewhere(10, 2, 0.05)), 2);
}

TEST_F(OutAndBack, IsCorrectedByItsLoops) {
  for (const int later : {36, 38, 40}) graph.offer(loop(later));
  const double moved_m = graph.optimize();
  EXPECT_NEAR(moved_m, 0.1, 0.01) << "the drift at the end of 20 m";
  EXPECT_EQ(graph.num_contradicted(), 0);
  EXPECT_EQ(graph.X_WK(0).matrix(), Pose::Identity().matrix());
  for (const int back : {36, 38, 40}) {
    const Pose X_EL = graph.X_WK(2 * kHalf - back).inverse() * graph.X_WK(back);
    EXPECT_LT((X_EL.translation()).norm(), 0.005) << "keyframe " << back;
  }
  EXPECT_EQ(graph.X_UK(40).matrix(), drifted(40).matrix()) << "what was tracked stays";
}

TEST_F(OutAndBack, ALoopThatTheOthersContradictIsGivenUpAndCounted) {
  for (const int later : {34, 35, 36, 37, 38, 39, 40}) graph.offer(loop(later));
  const Pose wrong = at(0.0, 0.12);
  graph.offer(loop(32, wrong));
  graph.offer(loop(30, wrong));
  ASSERT_EQ(graph.loops().size(), 9U) << "the wrong ones agree with each other";
  graph.optimize();
  EXPECT_EQ(graph.num_contradicted(), 2);
  EXPECT_EQ(graph.loops().size(), 7U);
  EXPECT_NEAR(graph.X_WK(40).translation().y(), 0.0, 0.005);
}

/// The surface has moved by 3 cm since the loops were found.
TEST_F(OutAndBack, LoopsAreAsMeasuredAnew) {
  for (const int later : {36, 38, 40}) graph.offer(loop(later));
  graph.optimize();
  const Pose X_39C = at(0.1, 0.2);
  const Pose X_2_39 = drifted(2).inverse() * drifted(39) * at(0.0, 0.03);
  ASSERT_TRUE(
      graph.renew({.tracked_near = 39, .X_TC = X_39C, .found_by = 2, .X_FC = X_2_39 * X_39C}));
  ASSERT_EQ(graph.loops().size(), 4U) << "and the view is one more";
  EXPECT_EQ(graph.loops().back().later, 39);
  EXPECT_EQ(graph.loops().back().earlier, 2);
  for (const Loop& each : graph.loops()) {
    const Pose X_2E = drifted(2).inverse() * drifted(each.earlier);
    const Pose X_L39 = drifted(each.later).inverse() * drifted(39);
    EXPECT_TRUE((X_2E * each.X_EL * X_L39).isApprox(X_2_39, 1e-9)) << each.later;
  }
  const std::vector<Loop> loops = graph.loops();
  ASSERT_TRUE(
      graph.renew({.tracked_near = 2, .X_TC = X_2_39 * X_39C, .found_by = 39, .X_FC = X_39C}));
  ASSERT_EQ(graph.loops().size(), 4U) << "the same view again";
  for (std::size_t i = 0; i < loops.size(); ++i) {
    EXPECT_TRUE(graph.loops()[i].X_EL.isApprox(loops[i].X_EL, 1e-9)) << "the other way round";
  }
}

TEST_F(OutAndBack, TheMapFollowsWhatIsMeasuredAnew) {
  for (const int later : {36, 38, 40}) graph.offer(loop(later));
  graph.optimize();
  const Pose X_2_39 = drifted(2).inverse() * drifted(39) * at(0.0, 0.03);
  const auto left_m = [&] {
    return (X_2_39.inverse() * graph.X_WK(2).inverse() * graph.X_WK(39)).translation().norm();
  };
  ASSERT_GT(left_m(), 0.02);
  SharedView view{.tracked_near = 39, .found_by = 2, .X_FC = X_2_39, .information_C = precise()};
  view.sigma_m = kSigma_m;
  graph.renew(view);
  graph.optimize();
  EXPECT_LT(left_m(), 0.005);
  EXPECT_EQ(graph.num_contradicted(), 0);
}

TEST_F(OutAndBack, NoLoopIsMeasuredAnewWhereNoneCounts) {
  graph.offer(loop(38));
  EXPECT_FALSE(graph.renew({.tracked_near = 39, .found_by = 2})) << "not confirmed";
  for (const int later : {26, 27}) graph.offer(loop(later));
  EXPECT_FALSE(graph.renew({.tracked_near = 39, .found_by = 2})) << "6 m of path away";
}

TEST_F(OutAndBack, WhatComesAfterACorrectionMovesWithTheKeyframeItComesFrom) {
  for (const int later : {38, 40}) graph.offer(loop(later));
  graph.optimize();
  graph.add(drifted(40) * at(0.0, 0.25), 40, 0.25);
  EXPECT_TRUE((graph.X_WK(40) * at(0.0, 0.25)).isApprox(graph.X_WK(41), 1e-9));
}

/// Along x and, after the camera was lost, along the same way again, which nobody knows.
class TwoParts : public ::testing::Test {
 protected:
  static constexpr int kLength = 20;  // keyframes of each part
  static constexpr double kUnseen_m = 12.0;

  TwoParts() {
    for (int i = 0; i < 2 * kLength; ++i) {
      const bool begins = i % kLength == 0;
      graph.add(X_UK(i), begins ? std::nullopt : std::optional(i - 1), kStep_m, unseen(i));
      if (!begins) graph.add_tracked(i - 1, i, precise());
    }
  }
  static std::optional<UnseenWay> unseen(int i) {
    if (i == 0) return std::nullopt;
    return UnseenWay{.before = i - 1, .distance_m = kUnseen_m};
  }
  static Pose truth(int i) { return at(kStep_m * (i % kLength)); }
  static Pose X_UK(int i) { return at(i < kLength ? 0.0 : 1'000.0) * truth(i); }
  /// Keyframe kLength + i is where keyframe i was, or `shift` from there.
  static Loop loop(int i, const Pose& shift = Pose::Identity()) {
    return {kLength + i, i, shift, precise(), kSigma_m};
  }
  int num_parts() const {
    const std::vector<int> parts = graph.parts();
    return static_cast<int>(std::set(parts.begin(), parts.end()).size());
  }

  KeyframeGraph graph{{}};
};

TEST_F(TwoParts, AreJoinedByLoopsThatAgree) {
  for (const int i : {3, 4, 5}) EXPECT_EQ(graph.offer(loop(i)), 0) << "only proposed";
  EXPECT_EQ(num_parts(), 2);
  const std::vector<Loop> loops = graph.agreeing_to_join(loop(5));
  ASSERT_EQ(loops.size(), 3U);
  graph.join(loops);
  EXPECT_EQ(num_parts(), 1);
  EXPECT_EQ(graph.loops().size(), 3U);
  graph.optimize();
  for (int i = 0; i < 2 * kLength; ++i) {
    EXPECT_TRUE(graph.X_WK(i).isApprox(truth(i), 1e-6)) << i;
    EXPECT_EQ(graph.part_of(i), 0);
  }
  EXPECT_TRUE(graph.agreeing_to_join(loop(5)).empty()) << "they are joined";
}

TEST_F(TwoParts, AreNotToBeJoinedAsLongAsOtherPlacesLookTheSame) {
  const Pose elsewhere = at(4.0);
  for (const int i : {3, 4}) graph.offer(loop(i));
  for (const int i : {6, 7}) graph.offer(loop(i, elsewhere));
  graph.offer(loop(5));
  EXPECT_TRUE(graph.agreeing_to_join(loop(5)).empty()) << "three are not more than twice two";
  graph.offer(loop(8));
  graph.offer(loop(2));
  EXPECT_EQ(graph.agreeing_to_join(loop(2)).size(), 5U);
}

TEST_F(TwoParts, AreNotJoinedWhereTheCameraCannotHaveGone) {
  // The second part would begin 15 m from where the first one ended.
  const Pose shift = at(-5.5);
  for (const int i : {3, 4, 5, 6}) graph.offer(loop(i, shift));
  EXPECT_TRUE(graph.agreeing_to_join(loop(6, shift)).empty());
}

/// Two cameras on the same way, whose keyframes come in turn.
class TwoCameras : public ::testing::Test {
 protected:
  static constexpr int kLength = 20;  // keyframes of each

  TwoCameras() {
    for (int i = 0; i < 2 * kLength; ++i) {
      const bool begins = i < 2;
      graph.add(X_UK(i), begins ? std::nullopt : std::optional(i - 2), kStep_m);
      if (!begins) graph.add_tracked(i - 2, i, precise());
    }
  }
  static Pose truth(int i) {
    const int number = i / 2;  // among those of its camera
    return at(kStep_m * number);
  }
  static Pose X_UK(int i) { return at(i % 2 == 0 ? 0.0 : 1'000.0) * truth(i); }
  /// Where both cameras have their i-th keyframe, or `shift` from there.
  static Loop loop(int i, const Pose& shift = Pose::Identity()) {
    return {2 * i + 1, 2 * i, shift, precise(), kSigma_m};
  }

  KeyframeGraph graph{{}};
};

TEST_F(TwoCameras, AreInOneMapWhereverTheSecondOneBegan) {
  const Pose far = at(500.0);
  for (const int i : {3, 4, 5}) graph.offer(loop(i, far));
  const std::vector<Loop> loops = graph.agreeing_to_join(loop(5, far));
  ASSERT_EQ(loops.size(), 3U) << "no camera went from the one to the other";
  graph.join(loops);
  graph.optimize();
  for (int i = 0; i < 2 * kLength; ++i) {
    EXPECT_EQ(graph.part_of(i), 0);
    const Pose expected = i % 2 == 0 ? truth(i) : Pose(far * truth(i));
    EXPECT_TRUE(graph.X_WK(i).isApprox(expected, 1e-6)) << i;
  }
}

TEST_F(TwoCameras, HaveLoopsOfOneDirectionWhoeverCameLast) {
  EXPECT_EQ(graph.later_and_earlier(30, 7), std::pair(7, 30)) << "7 is of the later part";
  EXPECT_EQ(graph.later_and_earlier(7, 30), std::pair(7, 30));
  EXPECT_EQ(graph.later_and_earlier(2, 30), std::pair(30, 2)) << "of one part";
}

TEST_F(TwoCameras, MayDriftOnBothWaysOnceTheyAreJoined) {
  for (const int i : {3, 4, 5}) graph.offer(loop(i));
  graph.join(graph.agreeing_to_join(loop(5)));
  EXPECT_GT(graph.offer(loop(6, at(0.0, 0.005))), 0) << "agrees with those of before";
  // 2 % of both ways since the last of these loops, 6.5 and 6 m each, are 26 and 24 cm.
  EXPECT_EQ(graph.offer(loop(19, at(0.0, 0.22))), 0) << "nothing agrees with it";
  EXPECT_EQ(graph.offer(loop(18, at(0.0, 0.22))), 2) << "they agree with each other";
  EXPECT_EQ(graph.offer(loop(17, at(0.0, 0.5))), 0);
  EXPECT_EQ(graph.offer(loop(16, at(0.0, 0.5))), 0) << "too far, though they agree";
}

TEST_F(TwoParts, AreOnTheWayToAThirdPart) {
  // The third part is where the second is, which is where the first is.
  for (int i = 0; i < kLength; ++i) {
    const bool begins = i == 0;
    graph.add(at(2'000.0) * truth(i), begins ? std::nullopt : std::optional(2 * kLength + i - 1),
              kStep_m, begins ? unseen(2 * kLength) : std::nullopt);
  }
  const auto third = [](int i, int earlier, const Pose& shift) {
    return Loop{2 * kLength + i, earlier, shift, precise(), kSigma_m};
  };
  for (const int i : {3, 4, 5}) graph.offer(loop(i));
  graph.join(graph.agreeing_to_join(loop(5)));
  for (const int i : {13, 14, 15}) graph.offer(third(i, kLength + i, Pose::Identity()));
  graph.join(graph.agreeing_to_join(third(15, kLength + 15, Pose::Identity())));
  ASSERT_EQ(num_parts(), 1);
  // From keyframe 16 of the third part to 15 of the second, to 5 of the first, to 16: 0.5, 5 and
  // 5.5 m, of which 2 % are 22 cm.
  EXPECT_EQ(graph.offer(third(16, 16, at(0.0, 0.3))), 0);
  EXPECT_EQ(graph.offer(third(17, 17, at(0.0, 0.3))), 0) << "too far, though they agree";
  EXPECT_EQ(graph.offer(third(16, 16, at(0.0, 0.2))), 0);
  EXPECT_EQ(graph.offer(third(17, 17, at(0.0, 0.2))), 2);
}

TEST_F(TwoParts, KeepTheirPlacesWhenOnlyOneIsCorrected) {
  graph.add(X_UK(0), 19, kStep_m * 19.0);
  graph.add(X_UK(1), 40, kStep_m);
  graph.add_tracked(40, 41, precise());
  graph.offer({40, 0, at(0.01), precise(), kSigma_m});
  graph.offer({41, 1, at(0.01), precise(), kSigma_m});
  graph.optimize();
  for (int i = kLength; i < 2 * kLength; ++i) {
    EXPECT_TRUE(graph.X_WK(i).isApprox(X_UK(i), 1e-12)) << i;
  }
}

TEST_F(OutAndBack, RefusesMotionsOfKeyframesThatAreNotThere) {
  EXPECT_THROW(graph.add_tracked(3, 99, precise()), std::invalid_argument);
  EXPECT_THROW(graph.add_tracked(-1, 3, precise()), std::invalid_argument);
  EXPECT_THROW(graph.add_tracked(3, 3, precise()), std::invalid_argument);
  EXPECT_THROW(graph.add(at(0.0), 41, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper

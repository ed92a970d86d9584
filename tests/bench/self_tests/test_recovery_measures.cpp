#include <gtest/gtest.h>

#include "tests/bench/recovery_measures.hpp"

namespace kintsugi::mapper::bench {
namespace {

Pose at(double x_m) {
  Pose X = Pose::Identity();
  X.translation().x() = x_m;
  return X;
}

FrameOutcome outcome(int frame, bool located, double x_m, double view_known = 1.0,
                     Damage damage = Damage::kNone) {
  FrameOutcome result;
  result.planned = {frame, frame * std::int64_t{100'000}, damage};
  result.located = located;
  result.tracking.X_WC = at(x_m);
  result.view_known = view_known;
  return result;
}

TEST(RecoveryMeasures, CountsErrorsOnBothSides) {
  const std::vector<std::optional<Pose>> reference = {at(0), at(1), at(2), at(3), std::nullopt};
  const RecoveryMeasures measures =
      measure({outcome(0, true, 0.029), outcome(1, true, 1.031), outcome(2, false, 1.031),
               outcome(3, false, 1.031, 0.4), outcome(4, true, 99)},
              reference, reference);
  EXPECT_EQ(measures.frames, 5);
  EXPECT_EQ(measures.located, 3);
  EXPECT_EQ(measures.off, 1);
  EXPECT_NEAR(measures.worst_error_m, 0.031, 1e-12);
  EXPECT_EQ(measures.good, 4);     // not frame 3: its view is new
  EXPECT_EQ(measures.refused, 1);  // frame 2
}

TEST(RecoveryMeasures, ToldApartFromDriftAWrongFusionDisagreesWithItsSurroundings) {
  std::vector<std::optional<Pose>> truth;
  std::vector<FrameOutcome> outcomes;
  for (int i = 0; i < 20; ++i) {  // 10 cm a frame, of which 4 mm are lost each time
    truth.emplace_back(at(0.1 * i));
    outcomes.push_back(outcome(i, true, 0.096 * i));
  }
  RecoveryMeasures measures = measure(outcomes, truth, truth);
  EXPECT_EQ(measures.misplaced, 0);
  EXPECT_EQ(measures.off, 12);
  for (int i = 15; i < 20; ++i) outcomes[i].tracking.X_WC.translation().y() = 0.2;
  measures = measure(outcomes, truth, truth);
  EXPECT_EQ(measures.misplaced, 5);  // also those that agree with each other
  EXPECT_GT(measures.worst_misplacement_m, 0.2 - 1e-9);
}

TEST(RecoveryMeasures, PartsOfTheMapAreNotComparedWithEachOther) {
  const std::vector<std::optional<Pose>> truth = {at(0), at(0.1), at(5), at(5.1)};
  std::vector<FrameOutcome> outcomes = {outcome(0, true, 0), outcome(1, true, 0.1),
                                        outcome(2, true, 1'000), outcome(3, true, 1'000.1)};
  outcomes[2].part = outcomes[3].part = 1;
  const RecoveryMeasures apart = measure(outcomes, truth, truth);
  EXPECT_EQ(apart.parts, 2);
  EXPECT_EQ(apart.misplaced, 0);
  EXPECT_EQ(apart.off, 0);
  outcomes[3].tracking.X_WC = at(1'000.2);
  EXPECT_EQ(measure(outcomes, truth, truth).misplaced, 1) << "within its part";
  outcomes[2].part = outcomes[3].part = 0;
  EXPECT_EQ(measure(outcomes, truth, truth).misplaced, 2) << "joined wrongly";
}

TEST(RecoveryMeasures, TimesALossFromItsFirstGoodFrame) {
  const std::vector<std::optional<Pose>> reference(10, at(0));
  const RecoveryMeasures measures =
      measure({outcome(0, true, 0), outcome(1, false, 0, 1.0, Damage::kWiped), outcome(2, false, 0),
               outcome(3, false, 0), outcome(4, true, 0), outcome(5, false, 0, 1.0, Damage::kWiped),
               outcome(6, true, 0), outcome(7, false, 0)},
              reference, reference);
  EXPECT_EQ(measures.recoveries, 1);  // the wiped frame 5 needs none
  EXPECT_NEAR(measures.median_recovery_s, 0.2, 1e-9);
  EXPECT_EQ(measures.never_recovered, 1);
}

TEST(RecoveryMeasures, ARotationCountsByWhatItDoesOneMetreAhead) {
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_NEAR(pose_error_m(X, Pose::Identity()), 0.05, 1e-4);
  EXPECT_NEAR(pose_error_m(at(0.2), Pose::Identity()), 0.2, 1e-12);
}

}  // namespace
}  // namespace kintsugi::mapper::bench

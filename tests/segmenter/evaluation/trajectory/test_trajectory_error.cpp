#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/evaluation/trajectory/trajectory_error.hpp"
#include "tests/lcmtypes/example_paths.hpp"

namespace kintsugi {
namespace {

using ::testing::ElementsAre;
using testing::helix;
using ::testing::IsEmpty;
using testing::moved;
using testing::random_pose;

// Double precision over paths of a few metres.
constexpr double kRounding = 1e-9;

Trajectory at_times(const std::vector<std::int64_t>& times_us) {
  Trajectory trajectory;
  for (const std::int64_t utime : times_us) trajectory.push_back({utime, Pose::Identity()});
  return trajectory;
}

/// associate.py, word by word: all pairs, sorted, taken while both are free.
std::vector<PosePair> associate_slowly(const Trajectory& estimate, const Trajectory& truth,
                                       std::int64_t max_difference_us) {
  std::vector<std::tuple<std::int64_t, std::int64_t, std::int64_t, PosePair>> matches;
  for (std::size_t t = 0; t < truth.size(); ++t) {
    for (std::size_t e = 0; e < estimate.size(); ++e) {
      const std::int64_t difference_us = std::abs(truth[t].utime - estimate[e].utime);
      if (difference_us < max_difference_us) {
        matches.emplace_back(difference_us, truth[t].utime, estimate[e].utime, PosePair{e, t});
      }
    }
  }
  const auto key = [](const auto& match) {
    return std::tuple(std::get<0>(match), std::get<1>(match), std::get<2>(match));
  };
  std::sort(matches.begin(), matches.end(),
            [&](const auto& a, const auto& b) { return key(a) < key(b); });
  std::vector<bool> is_truth_taken(truth.size());
  std::vector<bool> is_estimate_taken(estimate.size());
  std::vector<PosePair> pairs;
  for (const auto& match : matches) {
    const PosePair pair = std::get<3>(match);
    if (is_truth_taken[pair.truth] || is_estimate_taken[pair.estimate]) continue;
    is_truth_taken[pair.truth] = is_estimate_taken[pair.estimate] = true;
    pairs.push_back(pair);
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const PosePair& a, const PosePair& b) { return a.truth < b.truth; });
  return pairs;
}

TEST(StatisticsOf, AreThoseOfTheWholePopulation) {
  const ErrorStatistics odd = statistics_of({5.0, 1.0, 3.0});
  EXPECT_EQ(odd.count, 3U);
  EXPECT_DOUBLE_EQ(odd.rmse, std::sqrt(35.0 / 3.0));
  EXPECT_DOUBLE_EQ(odd.mean, 3.0);
  EXPECT_DOUBLE_EQ(odd.median, 3.0);
  EXPECT_DOUBLE_EQ(odd.std, std::sqrt(8.0 / 3.0));
  EXPECT_DOUBLE_EQ(odd.min, 1.0);
  EXPECT_DOUBLE_EQ(odd.max, 5.0);
  EXPECT_DOUBLE_EQ(statistics_of({4.0, 1.0, 2.0, 10.0}).median, 3.0);
  EXPECT_EQ(statistics_of({}).count, 0U);
}

TEST(Associate, TakesTheNearestPairsFirstAndEachPoseOnce) {
  // 10,000 is nearer to 11,000 than to 5,000, which then has none left within reach.
  EXPECT_THAT(associate(at_times({5'000, 11'000}), at_times({10'000})),
              ElementsAre(PosePair{1, 0}));
  // A greedy choice is not the one with the most pairs: 1 and 2 are paired, 0 stays alone.
  EXPECT_THAT(associate(at_times({0, 14'000}), at_times({13'000, 30'000})),
              ElementsAre(PosePair{1, 0}));
}

TEST(Associate, NeedsLessThanTheGreatestDifference) {
  EXPECT_THAT(associate(at_times({20'000}), at_times({0})), IsEmpty());
  EXPECT_THAT(associate(at_times({19'999}), at_times({0})), ElementsAre(PosePair{0, 0}));
  EXPECT_THAT(associate(at_times({0}), at_times({19'999})), ElementsAre(PosePair{0, 0}));
  EXPECT_THAT(associate({}, at_times({0})), IsEmpty());
}

TEST(Associate, OfPairsEquallyNearTakesTheEarlierTruthThenTheEarlierEstimate) {
  EXPECT_THAT(associate(at_times({10'000}), at_times({5'000, 15'000})),
              ElementsAre(PosePair{0, 0}));
  EXPECT_THAT(associate(at_times({5'000, 15'000}), at_times({10'000})),
              ElementsAre(PosePair{0, 0}));
}

TEST(Associate, AgreesWithTheSlowWay) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 200; ++round) {
    // Coarse times, so that many differences are equal; some rounds dense, some sparse.
    const std::int64_t step_us = 1'000 << (round % 5);
    const auto times = [&](std::size_t count) {
      std::vector<std::int64_t> values_us;
      std::int64_t utime = 0;
      while (values_us.size() < count) {
        utime += static_cast<std::int64_t>(1 + random() % 6) * step_us;
        values_us.push_back(utime);
      }
      return at_times(values_us);
    };
    const Trajectory estimate = times(random() % 40);
    const Trajectory truth = times(random() % 40);
    EXPECT_EQ(associate(estimate, truth), associate_slowly(estimate, truth, 20'000)) << round;
  }
}

TEST(AbsoluteTrajectoryError, IgnoresTheChoiceOfFrame) {
  const Trajectory truth = helix(60);
  std::mt19937_64 random(1);
  const auto error = absolute_trajectory_error(moved(random_pose(random), truth), truth);
  EXPECT_EQ(error.translation_m.count, 60U);
  EXPECT_LT(error.translation_m.max, kRounding);
}

TEST(AbsoluteTrajectoryError, GivesTheAlignment) {
  const Trajectory truth = helix(60);
  std::mt19937_64 random(2);
  const Pose X_WT = random_pose(random);
  const auto error = absolute_trajectory_error(moved(X_WT, truth), truth);
  EXPECT_TRUE((error.X_TW * X_WT).matrix().isIdentity(kRounding));
}

TEST(AbsoluteTrajectoryError, DoesNotForgiveScale) {
  const Trajectory truth = helix(60);
  Trajectory grown = truth;
  for (StampedPose& pose : grown) pose.X_WC.translation() *= 1.1;
  // What is left is 10 % of the distance of each pose from the mean of all.
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const StampedPose& pose : truth) mean += pose.X_WC.translation() / 60.0;
  double squares = 0.0;
  for (const StampedPose& pose : truth) {
    squares += (0.1 * (pose.X_WC.translation() - mean)).squaredNorm();
  }
  EXPECT_NEAR(absolute_trajectory_error(grown, truth).translation_m.rmse, std::sqrt(squares / 60.0),
              kRounding);
}

TEST(AbsoluteTrajectoryError, IsTheDistanceAcrossALineForAZigzag) {
  // True positions on a line; estimates alternate 3 cm to either side of it. As the offsets sum to
  // zero and are (for pairs left-right-right-left) uncorrelated with x, the line stays where it is.
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i < 40; ++i) {
    StampedPose pose{std::int64_t{i} * 33'333, Pose::Identity()};
    pose.X_WC.translation().x() = 0.1 * i;
    truth.push_back(pose);
    pose.X_WC.translation().y() = (i % 4 == 0 || i % 4 == 3) ? 0.03 : -0.03;
    estimate.push_back(pose);
  }
  const ErrorStatistics error = absolute_trajectory_error(estimate, truth).translation_m;
  EXPECT_NEAR(error.rmse, 0.03, kRounding);
  EXPECT_NEAR(error.std, 0.0, kRounding);
}

TEST(AbsoluteTrajectoryError, SkipsPosesWithoutATrueOneAndNeedsThree) {
  const Trajectory truth = helix(60);
  Trajectory few(truth.begin(), truth.begin() + 2);
  EXPECT_THROW(absolute_trajectory_error(few, truth), std::invalid_argument);
  few.push_back(truth[40]);
  few.push_back({truth.back().utime + 1'000'000, Pose::Identity()});
  EXPECT_EQ(absolute_trajectory_error(few, truth).translation_m.count, 3U);
}

TEST(PathDrift, IsTheErrorAtTheEndOverTheLength) {
  // A straight path of 10 m; the estimate believes in 9.8 m.
  Trajectory truth;
  for (int i = 0; i <= 100; ++i) {
    truth.push_back({std::int64_t{i} * 33'333, Pose(Eigen::Translation3d(0.1 * i, 0, 0))});
  }
  Trajectory estimate = truth;
  for (StampedPose& pose : estimate) pose.X_WC.translation() *= 0.98;
  std::mt19937_64 random(3);
  const PathDrift drift = path_drift(moved(random_pose(random), estimate), truth);
  EXPECT_EQ(drift.num_pairs, 101U);
  EXPECT_NEAR(drift.path_length_m, 10.0, kRounding);
  EXPECT_NEAR(drift.end_translation_m, 0.2, kRounding);
  EXPECT_NEAR(drift.end_rotation_rad, 0.0, kRounding);
  EXPECT_NEAR(drift.percent(), 2.0, 100 * kRounding);
}

TEST(PathDrift, TurnsWithTheFirstPose) {
  // Everything right but the first orientation, off by 0.1 rad about z: aligning it turns the end,
  // 2 m away, by a chord of 2 * 2 sin(0.05).
  Trajectory truth;
  for (int i = 0; i <= 20; ++i) {
    truth.push_back({std::int64_t{i} * 33'333, Pose(Eigen::Translation3d(0.1 * i, 0, 0))});
  }
  Trajectory estimate = truth;
  estimate.front().X_WC.rotate(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()));
  const PathDrift drift = path_drift(estimate, truth);
  EXPECT_NEAR(drift.end_translation_m, 4.0 * std::sin(0.05), kRounding);
  EXPECT_NEAR(drift.end_rotation_rad, 0.1, kRounding);
}

TEST(PathDrift, OfACameraThatStandsIsZeroPercent) {
  const Trajectory still = at_times({0, 33'333, 66'667});
  EXPECT_DOUBLE_EQ(path_drift(still, still).percent(), 0.0);
}

}  // namespace
}  // namespace kintsugi

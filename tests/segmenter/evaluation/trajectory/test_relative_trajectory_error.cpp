#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/evaluation/trajectory/relative_trajectory_error.hpp"
#include "tests/lcmtypes/example_paths.hpp"

namespace kintsugi {
namespace {

using testing::helix;
using testing::moved;
using testing::random_pose;

// Double precision over paths of a few metres.
constexpr double kRounding = 1e-9;
// The reference takes angles by acos of the trace, which near zero is good to the root of that.
constexpr double kAngleRounding_rad = 1e-7;

using Config = RelativeTrajectoryErrorConfig;

/// A straight path at `speed` m/s along x that turns by `turn` rad/s about x.
Trajectory straight(int poses, double speed, double turn) {
  Trajectory trajectory;
  for (int i = 0; i < poses; ++i) {
    StampedPose pose{std::int64_t{i} * 100'000, Pose::Identity()};
    pose.X_WC.linear() =
        Eigen::AngleAxisd(0.1 * turn * i, Eigen::Vector3d::UnitX()).toRotationMatrix();
    pose.X_WC.translation().x() = 0.1 * speed * i;
    trajectory.push_back(pose);
  }
  return trajectory;
}

// A transcription of evaluate_rpe.py with lists searched from one end to the other.
namespace slow {

Eigen::Matrix4d ominus(const Eigen::Matrix4d& a, const Eigen::Matrix4d& b) {
  return a.inverse() * b;
}

double angle(const Eigen::Matrix4d& m) {
  return std::acos(std::min(1.0, std::max(-1.0, (m.topLeftCorner<3, 3>().trace() - 1.0) / 2.0)));
}

std::size_t closest(const std::vector<double>& list, double value) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < list.size(); ++i) {
    if (std::abs(list[i] - value) < std::abs(list[best] - value)) best = i;
  }
  return best;
}

std::vector<double> stamps(const Trajectory& trajectory) {
  std::vector<double> stamps_s;
  for (const auto& pose : trajectory) stamps_s.push_back(1e-6 * static_cast<double>(pose.utime));
  return stamps_s;
}

std::vector<double> index_of(const Trajectory& trajectory, DeltaUnit unit) {
  if (unit == DeltaUnit::kSeconds) return stamps(trajectory);
  std::vector<double> index;
  double sum = 0.0;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (i > 0) {
      const Eigen::Matrix4d motion =
          ominus(trajectory[i].X_WC.matrix(), trajectory[i - 1].X_WC.matrix());
      if (unit == DeltaUnit::kFrames) sum += 1.0;
      if (unit == DeltaUnit::kMetres) sum += motion.topRightCorner<3, 1>().norm();
      if (unit == DeltaUnit::kDegrees) sum += angle(motion) * 180.0 / M_PI;
    }
    index.push_back(sum);
  }
  return index;
}

struct Errors {
  std::vector<double> translations_m;
  std::vector<double> rotations_rad;
};

Errors evaluate(const Trajectory& estimate, const Trajectory& truth, const Config& config) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  if (config.fixed_delta) {
    const auto index = index_of(estimate, config.delta_unit);
    for (std::size_t i = 0; i < estimate.size(); ++i) {
      const std::size_t j = closest(index, index[i] + config.delta);
      if (j != estimate.size() - 1) pairs.emplace_back(i, j);
    }
  } else {
    for (std::size_t i = 0; i < estimate.size(); ++i) {
      for (std::size_t j = 0; j < estimate.size(); ++j) pairs.emplace_back(i, j);
    }
  }
  const auto stamps_gt = stamps(truth);
  const auto stamps_est = stamps(estimate);
  std::vector<double> intervals;
  for (std::size_t i = 1; i < stamps_gt.size(); ++i) {
    intervals.push_back(stamps_gt[i] - stamps_gt[i - 1]);
  }
  const double max_difference = 2.0 * statistics_of(intervals).median;
  Errors errors;
  for (const auto& [i, j] : pairs) {
    const std::size_t gt_0 = closest(stamps_gt, stamps_est[i]);
    const std::size_t gt_1 = closest(stamps_gt, stamps_est[j]);
    if (std::abs(stamps_gt[gt_0] - stamps_est[i]) > max_difference) continue;
    if (std::abs(stamps_gt[gt_1] - stamps_est[j]) > max_difference) continue;
    const Eigen::Matrix4d error =
        ominus(ominus(estimate[j].X_WC.matrix(), estimate[i].X_WC.matrix()),
               ominus(truth[gt_1].X_WC.matrix(), truth[gt_0].X_WC.matrix()));
    errors.translations_m.push_back(error.topRightCorner<3, 1>().norm());
    errors.rotations_rad.push_back(angle(error));
  }
  return errors;
}

}  // namespace slow

void expect_near(const ErrorStatistics& actual, const ErrorStatistics& expected, double tolerance) {
  EXPECT_EQ(actual.count, expected.count);
  EXPECT_NEAR(actual.rmse, expected.rmse, tolerance);
  EXPECT_NEAR(actual.mean, expected.mean, tolerance);
  EXPECT_NEAR(actual.median, expected.median, tolerance);
  EXPECT_NEAR(actual.std, expected.std, tolerance);
  EXPECT_NEAR(actual.min, expected.min, tolerance);
  EXPECT_NEAR(actual.max, expected.max, tolerance);
}

TEST(RelativeTrajectoryError, IgnoresTheChoiceOfFrame) {
  const Trajectory truth = helix(60);
  std::mt19937_64 random(1);
  const auto error =
      relative_trajectory_error(moved(random_pose(random), truth), truth, {.delta = 0.5});
  EXPECT_LT(error.translation_m.max, kRounding);
  EXPECT_LT(error.rotation_rad.max, kAngleRounding_rad);
}

TEST(RelativeTrajectoryError, OfAPathTooFastIsTheExcessPerInterval) {
  // 0.50 m/s and 0.20 rad/s believed to be 0.53 and 0.23: every second is off by 3 cm, 30 mrad.
  const auto error =
      relative_trajectory_error(straight(50, 0.53, 0.23), straight(50, 0.50, 0.20), {.delta = 1.0});
  // From poses 0 to 38 to the one ten on; from 39 on the nearest is the last one.
  EXPECT_EQ(error.translation_m.count, 39U);
  EXPECT_NEAR(error.translation_m.min, 0.03, kRounding);
  EXPECT_NEAR(error.translation_m.max, 0.03, kRounding);
  EXPECT_NEAR(error.rotation_rad.min, 0.03, kAngleRounding_rad);
  EXPECT_NEAR(error.rotation_rad.max, 0.03, kAngleRounding_rad);
}

TEST(RelativeTrajectoryError, MeasuresItsIntervalAlongTheEstimate) {
  const Trajectory estimate = straight(50, 0.53, 0.23);
  const Trajectory truth = straight(50, 0.50, 0.20);
  const auto mean_m = [&](double delta, DeltaUnit unit) {
    return relative_trajectory_error(estimate, truth, {.delta = delta, .delta_unit = unit})
        .translation_m.mean;
  };
  EXPECT_NEAR(mean_m(5, DeltaUnit::kFrames), 0.015, kRounding);
  EXPECT_NEAR(mean_m(0.53, DeltaUnit::kMetres), 0.03, kRounding);
  EXPECT_NEAR(mean_m(0.46 * 180.0 / M_PI, DeltaUnit::kDegrees), 0.06, kRounding);
}

TEST(RelativeTrajectoryError, OfAllPairsHasThoseOfEachPoseWithItself) {
  const auto error = relative_trajectory_error(straight(10, 0.6, 0.0), straight(10, 0.5, 0.0),
                                               {.fixed_delta = false});
  // i - j = k tenths of a second, 10 - |k| times each: the error is |k| cm.
  double sum_m = 0.0;
  for (int k = -9; k <= 9; ++k) sum_m += (10 - std::abs(k)) * 0.01 * std::abs(k);
  EXPECT_EQ(error.translation_m.count, 100U);
  EXPECT_DOUBLE_EQ(error.translation_m.min, 0.0);
  EXPECT_NEAR(error.translation_m.mean, sum_m / 100.0, kRounding);
}

TEST(RelativeTrajectoryError, OfManyPairsDrawsTheSameEachTime) {
  std::mt19937_64 random(4);
  const Trajectory truth = helix(300);
  Trajectory estimate = truth;
  for (StampedPose& pose : estimate) pose.X_WC = pose.X_WC * random_pose(random, 0.01, 0.01);
  const Config all = {.fixed_delta = false, .max_pairs = 90'000};
  const Config some = {.fixed_delta = false, .max_pairs = 10'000};
  const auto drawn = relative_trajectory_error(estimate, truth, some);
  const auto again = relative_trajectory_error(estimate, truth, some);
  const auto whole = relative_trajectory_error(estimate, truth, all);
  EXPECT_EQ(drawn.translation_m.count, 10'000U);
  EXPECT_EQ(whole.translation_m.count, 90'000U);
  EXPECT_EQ(drawn.translation_m.rmse, again.translation_m.rmse);
  // 10,000 draws estimate a mean to 1 % of the spread; five times that does not happen by chance.
  EXPECT_NEAR(drawn.translation_m.mean, whole.translation_m.mean, 0.05 * whole.translation_m.std);
}

TEST(RelativeTrajectoryError, AgreesWithTheSlowWay) {
  std::mt19937_64 random(11);
  for (int round = 0; round < 40; ++round) {
    Trajectory truth;
    Trajectory estimate;
    std::int64_t utime = 1'341'836'537'655'691;
    Pose X_WC = random_pose(random);
    for (int i = 0; i < 80; ++i) {
      utime += 9'000 + static_cast<std::int64_t>(random() % 3'000);
      // Now and then a gap in the truth, wider than two of its intervals.
      if (i % 25 == 24) utime += 70'000;
      X_WC = X_WC * random_pose(random, 0.02, 0.02);
      truth.push_back({utime, X_WC});
    }
    std::int64_t estimated_utime = truth.front().utime - 30'000;
    while (estimated_utime < truth.back().utime + 30'000) {
      estimated_utime += 25'000 + static_cast<std::int64_t>(random() % 10'000);
      estimate.push_back({estimated_utime, random_pose(random, 0.5, 0.5)});
    }
    for (const Config& config :
         {Config{.delta = 0.1, .delta_unit = DeltaUnit::kSeconds},
          Config{.delta = 3, .delta_unit = DeltaUnit::kFrames},
          Config{.delta = 1.7, .delta_unit = DeltaUnit::kMetres},
          Config{.delta = 90, .delta_unit = DeltaUnit::kDegrees}, Config{.fixed_delta = false}}) {
      const auto actual = relative_trajectory_error(estimate, truth, config);
      const auto expected = slow::evaluate(estimate, truth, config);
      expect_near(actual.translation_m, statistics_of(expected.translations_m), kRounding);
      expect_near(actual.rotation_rad, statistics_of(expected.rotations_rad), kAngleRounding_rad);
    }
  }
}

TEST(RelativeTrajectoryError, LeavesOutMotionsWithoutTruth) {
  const Trajectory truth = straight(20, 0.5, 0.0);
  Trajectory longer = straight(60, 0.5, 0.0);
  const auto error = relative_trajectory_error(longer, truth, {.delta = 0.5});
  // The truth counts for two intervals beyond its end: for poses up to 21, so to motions from 16.
  EXPECT_EQ(error.translation_m.count, 17U);
}

TEST(RelativeTrajectoryError, SaysWhatItCannotDo) {
  const Trajectory path = straight(20, 0.5, 0.0);
  const auto expect_refused = [&](const Trajectory& estimate, const Config& config,
                                  const std::string& message) {
    try {
      relative_trajectory_error(estimate, path, config);
      ADD_FAILURE() << "accepted, expected: " << message;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(message));
    }
  };
  expect_refused(path, {.delta = 0.0}, "delta is 0.0");
  expect_refused(path, {.delta = std::nan("")}, "delta is nan");
  expect_refused(path, {.delta = INFINITY}, "delta is inf");
  expect_refused(path, {.max_pairs = 0}, "max_pairs is 0");
  expect_refused(path, {.delta = 5.0}, "0 motions over the given delta");
  expect_refused({path.front()}, {}, "have 1 and 20 poses");
  Trajectory later = path;
  for (StampedPose& pose : later) pose.utime += 3'600'000'000;
  expect_refused(later, {}, "0 motions");
}

}  // namespace
}  // namespace kintsugi

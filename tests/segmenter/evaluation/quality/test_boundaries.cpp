// Boundaries between segments against true ones: closed forms on a line of points, and every pair
// of points looked at.

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/evaluation/quality/boundaries.hpp"
#include "segmenter/evaluation/quality/overlap.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using Labels = std::vector<std::uint32_t>;

// Shares of counts: equal but for the division.
constexpr double kRounding = 1e-12;
// Points 1 cm apart: those 1 apart are near each other, those 2 apart are neighbours, 3 are not.
constexpr double kStep_m = 0.01;
const BoundaryConfig kConfig{.radius_m = 2.5 * kStep_m, .tolerance_m = 1.1 * kStep_m};

std::vector<CloudPoint> line(int num_points) {
  std::vector<CloudPoint> points;
  for (int i = 0; i < num_points; ++i) {
    points.push_back(testing::make_point(kStep_m * i, 0.0, 0.0, 0.0, 0.0, 1.0));
  }
  return points;
}

/// Label 1 for the points before `boundary`, 2 from there on.
Labels cut_at(int num_points, int boundary) {
  Labels labels;
  for (int i = 0; i < num_points; ++i) labels.push_back(i < boundary ? 1 : 2);
  return labels;
}

TEST(QualityBoundaries, TheTruthItselfIsPerfect) {
  const auto score = boundary_score(line(100), cut_at(100, 50), cut_at(100, 50), kConfig);
  EXPECT_EQ(score.num_true, 4);  // two on each side
  EXPECT_EQ(score.num_found, 4);
  EXPECT_EQ(score.recall, 1.0);
  EXPECT_EQ(score.precision, 1.0);
}

TEST(QualityBoundaries, AShiftedBoundaryIsFoundAsFarAsItOverlaps) {
  // Bands of 4 points; one point beside a band is near it.
  const std::vector<std::pair<int, double>> shift_and_recall = {{0, 1.0}, {1, 1.0},  {2, 0.75},
                                                                {3, 0.5}, {4, 0.25}, {5, 0.0}};
  for (const auto& [shift, recall] : shift_and_recall) {
    const auto score = boundary_score(line(100), cut_at(100, 50), cut_at(100, 50 + shift), kConfig);
    EXPECT_NEAR(score.recall, recall, kRounding) << shift;
    EXPECT_NEAR(score.precision, recall, kRounding) << shift;
  }
}

TEST(QualityBoundaries, OneSegmentFindsNoneAndIsNotWrong) {
  const auto score = boundary_score(line(100), cut_at(100, 50), Labels(100, 9), kConfig);
  EXPECT_EQ(score.recall, 0.0);
  EXPECT_EQ(score.precision, 1.0);
  EXPECT_EQ(score.num_found, 0);
}

TEST(QualityBoundaries, CrumbsFindAllAndAreMostlyWrong) {
  Labels crumbs;
  for (std::uint32_t i = 1; i <= 100; ++i) crumbs.push_back(i);
  const auto score = boundary_score(line(100), cut_at(100, 50), crumbs, kConfig);
  EXPECT_EQ(score.recall, 1.0);
  EXPECT_NEAR(score.precision, 0.06, kRounding);  // the band, and one on either side of it
}

TEST(QualityBoundaries, PointsWithoutInstanceMakeNone) {
  Labels instances = cut_at(100, 50);
  for (std::size_t i = 46; i < 54; ++i) instances[i] = kNoInstance;
  const auto score = boundary_score(line(100), instances, cut_at(100, 50), kConfig);
  EXPECT_EQ(score.num_true, 0);  // what is left of both is too far apart
  EXPECT_EQ(score.num_found, 0);
}

/// All pairs. The distance is squared_distance() in float32, as neighbours are found.
BoundaryScore slow_score(const std::vector<CloudPoint>& points, const Labels& instances,
                         const Labels& segments) {
  const auto distance_below = [&](std::size_t i, std::size_t j, double bound_m) {
    const float dx = points[i].x - points[j].x;
    const float dy = points[i].y - points[j].y;
    const float dz = points[i].z - points[j].z;
    return std::sqrt(static_cast<double>(dx * dx + dy * dy + dz * dz)) < bound_m;
  };
  const auto is_known = [&](std::size_t i) { return instances[i] != kNoInstance; };
  const auto boundary_of = [&](const Labels& labels) {
    std::vector<std::size_t> boundary;
    for (std::size_t i = 0; i < points.size(); ++i) {
      bool found = false;
      for (std::size_t j = 0; j < points.size() && is_known(i); ++j) {
        found = found ||
                (is_known(j) && labels[i] != labels[j] && distance_below(i, j, kConfig.radius_m));
      }
      if (found) boundary.push_back(i);
    }
    return boundary;
  };
  const auto share_near = [&](const auto& of, const auto& others) {
    double near = 0.0;
    for (const std::size_t i : of) {
      bool found = false;
      for (const std::size_t j : others) {
        found = found || distance_below(i, j, kConfig.tolerance_m);
      }
      near += found ? 1.0 : 0.0;
    }
    return of.empty() ? 1.0 : near / static_cast<double>(of.size());
  };
  const auto is_true = boundary_of(instances);
  const auto is_found = boundary_of(segments);
  return {std::ssize(is_true), std::ssize(is_found), share_near(is_true, is_found),
          share_near(is_found, is_true)};
}

TEST(QualityBoundaries, RandomCloudsScoreAsEveryPairSays) {
  std::mt19937 generator(5);
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const auto shape =
        seed % 2 == 0 ? testing::CloudShape::kWaves : testing::CloudShape::kUnrelated;
    const auto points = testing::random_cloud(shape, 400, seed);
    Labels instances;
    Labels segments;
    for (const CloudPoint& p : points) {
      const double wobble_m = 0.02 * static_cast<double>(generator() % 100) / 100.0;
      instances.push_back(p.x < 0.06F ? 1 : p.y < 0.1F ? 2 : generator() % 20 == 0 ? 0 : 3);
      segments.push_back(p.x < 0.06 + wobble_m ? 4 : p.y < 0.11F ? 2 : 0);
    }
    const auto slow = slow_score(points, instances, segments);
    const auto score = boundary_score(points, instances, segments, kConfig);
    EXPECT_EQ(score.num_true, slow.num_true);
    EXPECT_EQ(score.num_found, slow.num_found);
    EXPECT_NEAR(score.recall, slow.recall, kRounding);
    EXPECT_NEAR(score.precision, slow.precision, kRounding);
    EXPECT_GT(slow.num_true, 20);
    EXPECT_LT(slow.precision, 1.0);
  }
}

TEST(QualityBoundaries, RefusesWhatMakesNoSense) {
  const auto points = line(3);
  const Labels labels = cut_at(3, 1);
  EXPECT_THROW(boundary_score(points, Labels{1}, labels, kConfig), std::invalid_argument);
  EXPECT_THROW(boundary_score(points, labels, labels, {.radius_m = 0.0}), std::invalid_argument);
  EXPECT_THROW(boundary_score(points, labels, labels, {.radius_m = 0.01, .tolerance_m = 0.01}),
               std::invalid_argument);
  auto broken = points;
  broken[1].x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(boundary_score(broken, labels, labels, kConfig), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::segmenter

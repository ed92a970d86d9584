#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "segmenter/core/graph/edge_weight.hpp"
#include "segmenter/core/make_engine.hpp"
#include "segmenter/evaluation/paper/theta_history.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

/// A chain along y whose normals turn about y, so that Eq. 2 gives 1 - cos: `weights[i]` between
/// points i and i + 1. Only points that follow each other are neighbours.
std::vector<CloudPoint> chain(const std::vector<double>& weights) {
  std::vector<CloudPoint> points;
  double angle = 0.0;
  for (std::size_t i = 0; i <= weights.size(); ++i) {
    points.push_back(testing::make_point(0.0, 0.015 * static_cast<double>(i), 0.0, std::sin(angle),
                                         0.0, std::cos(angle)));
    if (i < weights.size()) angle += std::acos(1.0 - weights[i]);
  }
  return points;
}

double theta(const std::vector<CloudPoint>& points, std::size_t i, int size) {
  return static_cast<double>(EdgeWeight()(points[i], points[i + 1])) + EngineConfig().scale / size;
}

ThetaHistory history_of_one_segment(const std::vector<CloudPoint>& points) {
  PointCloud cloud;
  cloud.add_slice(0, points);
  const std::vector<PointIndex> labels(points.size(), 0);
  const auto histories = theta_histories(cloud, labels, std::vector<PointIndex>{0}, {});
  EXPECT_EQ(histories.size(), 1U);
  return histories.at(0);
}

TEST(ThetaHistory, OfAChainThatGrowsPointByPoint) {
  const auto points = chain({1e-5, 2e-5, 3e-5});
  const ThetaHistory history = history_of_one_segment(points);
  EXPECT_EQ(history.num_points, (std::vector<std::int64_t>{1, 2, 3, 4}));
  EXPECT_EQ(history.theta, (std::vector<double>{0.001, theta(points, 0, 2), theta(points, 1, 3),
                                                theta(points, 2, 4)}));
}

TEST(ThetaHistory, FollowsTheLargerOfTwoPieces) {
  // Points 2, 3 and 4 join, then 0 and 1, then both pieces.
  const auto points = chain({3e-5, 4e-5, 1e-5, 2e-5});
  const ThetaHistory history = history_of_one_segment(points);
  EXPECT_EQ(history.num_points, (std::vector<std::int64_t>{1, 2, 3, 5}));
  EXPECT_EQ(history.theta, (std::vector<double>{0.001, theta(points, 2, 2), theta(points, 3, 3),
                                                theta(points, 1, 5)}));
}

TEST(ThetaHistory, EndsAtTheThresholdAndSizeThatBatchHas) {
  PointCloud cloud;
  cloud.add_slice(0, testing::random_cloud(testing::CloudShape::kWaves, 3000, 2));
  const EngineConfig config;
  const auto batch = make_engine("batch", cloud, config);
  batch->update(cloud.take_change());
  const auto labels = canonical_labels(batch->components());
  std::map<PointIndex, std::int64_t> sizes;
  for (const PointIndex label : labels) ++sizes[label];
  std::vector<PointIndex> segments;
  for (const auto& [label, size] : sizes) {
    if (size >= 10) segments.push_back(label);
  }
  ASSERT_GT(segments.size(), 5U);

  const auto histories = theta_histories(cloud, labels, segments, config);
  ASSERT_EQ(histories.size(), segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    EXPECT_EQ(histories[i].label, segments[i]);
    EXPECT_EQ(histories[i].num_points.back(), sizes[segments[i]]);
    EXPECT_EQ(histories[i].theta.back(), batch->theta(batch->components()[segments[i]]));
    EXPECT_TRUE(std::is_sorted(histories[i].num_points.begin(), histories[i].num_points.end()));
  }
}

TEST(ThetaHistory, OfASinglePointIsT) {
  const ThetaHistory history = history_of_one_segment(chain({}));
  EXPECT_EQ(history.theta, std::vector<double>{0.001});
}

}  // namespace
}  // namespace kintsugi::segmenter

// look_ahead() does not change the result.

#include <algorithm>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/make_engine.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using Slice = std::vector<CloudPoint>;

/// Neighbouring strips of a wavy sheet; each has a point that is turned away.
std::vector<Slice> strips(int num_slices, int points_per_slice) {
  auto points =
      testing::random_cloud(testing::CloudShape::kWaves, num_slices * points_per_slice, 8);
  std::sort(points.begin(), points.end(),
            [](const CloudPoint& a, const CloudPoint& b) { return a.x < b.x; });
  std::vector<Slice> slices;
  for (int k = 0; k < num_slices; ++k) {
    const auto first = points.begin() + std::ptrdiff_t{k} * points_per_slice;
    Slice& slice = slices.emplace_back(first, first + points_per_slice);
    slice[5].x = std::numeric_limits<float>::quiet_NaN();
  }
  return slices;
}

class LookAhead : public ::testing::TestWithParam<NeighbourSearch> {
 protected:
  EngineConfig config() const {
    return {.rebuild_share = 1e9, .audit = true, .neighbour_search = GetParam()};
  }
};

TEST_P(LookAhead, ChangesNothing) {
  const auto slices = strips(12, 300);
  PointCloud cloud;
  PointCloud told_cloud;
  const auto engine = make_engine("exact", cloud, config());
  const auto told_engine = make_engine("exact", told_cloud, config());
  for (std::size_t k = 0; k < slices.size(); ++k) {
    const auto id = static_cast<std::int32_t>(k);
    cloud.add_slice(id, slices[k]);
    told_cloud.add_slice(id, slices[k]);
    if (k + 1 < slices.size()) told_engine->look_ahead(slices[k + 1]);
    const RunStatistics run = engine->update(cloud.take_change());
    const RunStatistics told_run = told_engine->update(told_cloud.take_change());
    EXPECT_EQ(told_run.num_edges, run.num_edges);
    EXPECT_EQ(told_run.num_joins, run.num_joins);
    ASSERT_TRUE(std::ranges::equal(told_engine->components(), engine->components()));
  }
}

TEST_P(LookAhead, MayBeWrong) {
  // The audit throws if an edge is missing or wrong.
  const auto slices = strips(8, 300);
  PointCloud cloud;
  const auto engine = make_engine("exact", cloud, config());
  std::mt19937 generator(2);
  for (std::size_t k = 0; k < slices.size(); ++k) {
    cloud.add_slice(static_cast<std::int32_t>(k), slices[k]);
    engine->look_ahead(slices[generator() % slices.size()]);
    EXPECT_NO_THROW(engine->update(cloud.take_change()));
  }
}

TEST_P(LookAhead, IsForgottenWhenPointsLeaveMeanwhile) {
  const auto slices = strips(3, 300);
  PointCloud cloud;
  const auto engine = make_engine("exact", cloud, config());
  cloud.add_slice(0, slices[0]);
  cloud.add_slice(1, slices[1]);
  engine->look_ahead(slices[2]);
  engine->update(cloud.take_change());
  cloud.replace_slice(1, std::span(slices[1]).first(200));  // the next slice's neighbours leave
  cloud.add_slice(2, slices[2]);
  EXPECT_NO_THROW(engine->update(cloud.take_change()));

  engine->look_ahead(slices[2]);
  cloud.replace_slice(2, {});
  engine->update(cloud.take_change());
  cloud.replace_slice(1, {});
  engine->update(cloud.take_change());
  cloud.replace_slice(2, slices[2]);
  EXPECT_NO_THROW(engine->update(cloud.take_change()));
}

INSTANTIATE_TEST_SUITE_P(Searches, LookAhead,
                         ::testing::Values(NeighbourSearch::kGrid, NeighbourSearch::kFlann));

}  // namespace
}  // namespace kintsugi::segmenter

// The tiles that a browser gets.

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "lcmtypes/scene/tile.hpp"
#include "tests/support/example_messages.hpp"

namespace kintsugi::scene {
namespace {

constexpr std::size_t kHeaderBytes = 64;

std::vector<CloudPoint> some_points(int count) {
  std::vector<CloudPoint> points = testing::example_slice(count).points_W;
  std::mt19937 random(5);
  std::normal_distribution<float> coordinate;
  for (CloudPoint& point : points) {
    const Eigen::Vector3f n =
        Eigen::Vector3f(coordinate(random), coordinate(random), coordinate(random)).normalized();
    point.nx = n.x();
    point.ny = n.y();
    point.nz = n.z();
  }
  return points;
}

/// As the shader of the page computes it.
Eigen::Vector3f normal_of(const std::uint8_t* record) {
  const float u = static_cast<float>(record[6]) / 127.0F - 1.0F;
  const float v = static_cast<float>(record[7]) / 127.0F - 1.0F;
  Eigen::Vector3f n(u, v, 1.0F - std::abs(u) - std::abs(v));
  if (n.z() < 0.0F) {
    n.x() = std::copysign(1.0F - std::abs(v), u);
    n.y() = std::copysign(1.0F - std::abs(u), v);
  }
  return n.normalized();
}

std::uint32_t word(const std::string& bytes, std::size_t index) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + 4 * index, sizeof(value));
  return value;
}

Tile tile_of(const std::vector<CloudPoint>& points, const std::vector<std::uint32_t>& ids) {
  Tile tile;
  tile.id = 9;
  tile.points = std::make_shared<const TilePoints>(make_points(points, 3));
  tile.labels = std::make_shared<const TileLabels>(make_labels(ids, 4));
  return tile;
}

TEST(TileOrder, HasEachPointOnce) {
  for (const std::uint32_t count : {1U, 2U, 3U, 10U, 618U, 1000U, 4096U, 65'537U}) {
    const TileOrder order(count);
    std::set<std::uint32_t> seen;
    for (std::uint32_t i = 0; i < count; ++i) seen.insert(order(i));
    EXPECT_EQ(seen.size(), count);
    EXPECT_LT(*seen.rbegin(), count);
  }
}

TEST(TileOrder, APrefixLiesEvenlyInTheWhole) {
  constexpr std::uint32_t kCount = 10'000;
  constexpr std::uint32_t kPrefix = 100;
  const TileOrder order(kCount);
  std::vector<std::uint32_t> prefix;
  for (std::uint32_t i = 0; i < kPrefix; ++i) prefix.push_back(order(i));
  std::ranges::sort(prefix);
  // Gaps of a golden ratio sequence have at most three lengths, of which the largest is less than
  // three times the mean.
  for (std::size_t i = 1; i < prefix.size(); ++i) {
    EXPECT_LT(prefix[i] - prefix[i - 1], 3 * kCount / kPrefix);
  }
}

TEST(TilePoints, HaveTheirPlacesWithinTheStepsOfTheBox) {
  const std::vector<CloudPoint> points = some_points(5000);
  const TilePoints tile = make_points(points, 1);
  const TileOrder order(tile.count);
  for (std::uint32_t i = 0; i < tile.count; ++i) {
    const CloudPoint& point = points[order(i)];
    const Eigen::Vector3f error = tile.position_P(i) - Eigen::Vector3f(point.x, point.y, point.z);
    for (int axis = 0; axis < 3; ++axis) {
      // Half a step, and the rounding of floats of up to 5 m.
      EXPECT_LE(std::abs(error[axis]), tile.box_size_P[axis] / 131'070.0F + 2e-6F);
    }
    const std::uint8_t* const record = &tile.records[i * kPointBytes];
    EXPECT_EQ(record[8], point.red);
    EXPECT_EQ(record[9], point.green);
    EXPECT_EQ(record[10], point.blue);
  }
}

TEST(TilePoints, HaveTheirNormalsWithinADegree) {
  const std::vector<CloudPoint> points = some_points(5000);
  const TilePoints tile = make_points(points, 1);
  const TileOrder order(tile.count);
  const float least_cosine = std::cos(std::numbers::pi_v<float> / 180.0F);
  for (std::uint32_t i = 0; i < tile.count; ++i) {
    const CloudPoint& point = points[order(i)];
    const Eigen::Vector3f n = normal_of(&tile.records[i * kPointBytes]);
    EXPECT_GT(n.dot(Eigen::Vector3f(point.nx, point.ny, point.nz)), least_cosine);
  }
}

TEST(TilePoints, WithoutNormalOrPlaceAreMarkedAndHarmless) {
  std::vector<CloudPoint> points = some_points(3);
  points[0].nx = points[0].ny = points[0].nz = 0.0F;
  points[0].x = NAN;
  const TilePoints tile = make_points(points, 1);
  EXPECT_EQ(tile.records[6], 255);  // the first in tile order is the first of the map
  EXPECT_EQ(tile.records[7], 255);
  EXPECT_EQ(tile.position_P(0).x(), tile.box_min_P.x());
  EXPECT_TRUE(tile.box_size_P.allFinite());
}

TEST(TilePoints, OfNoPointsAreEmpty) {
  const TilePoints tile = make_points({}, 1);
  EXPECT_EQ(tile.count, 0U);
  EXPECT_TRUE(tile.box_size_P.isZero());
}

TEST(TileLabels, TakeAsManyBytesAsTheyNeed) {
  for (const std::uint32_t segments : {1U, 256U, 257U, 65'536U, 65'537U}) {
    std::vector<std::uint32_t> ids(70'000);
    for (std::uint32_t i = 0; i < ids.size(); ++i) ids[i] = 1'000'000 + i % segments;
    const TileLabels labels = make_labels(ids, 1);
    EXPECT_EQ(labels.index_bytes, segments <= 256 ? 1U : segments <= 65'536 ? 2U : 4U);
    const TileOrder order(static_cast<std::uint32_t>(ids.size()));
    for (std::uint32_t i = 0; i < ids.size(); i += 7) EXPECT_EQ(labels.label(i), ids[order(i)]);
  }
}

TEST(Block, HasARangeOfPointsAndTheirLabels) {
  const std::vector<CloudPoint> points = some_points(100);
  std::vector<std::uint32_t> ids(100, 5);
  ids[0] = 6;
  const Tile tile = tile_of(points, ids);
  std::string block;
  append_block(tile, 0, 10, true, block);
  const std::vector<std::uint32_t> expected{0x314C544B, 9, 3, 4, 0, 10, 100, 2, 1, 1};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(word(block, i), expected[i]);
  EXPECT_EQ(word(block, 16), 6U);  // the table, behind the box
  EXPECT_EQ(word(block, 17), 5U);
  EXPECT_EQ(block[kHeaderBytes + 8], 0);
  EXPECT_EQ(block[kHeaderBytes + 9], 1);
  EXPECT_EQ(block.size(), kHeaderBytes + 8 + 12 + 112);
  const std::size_t points_at = kHeaderBytes + 8 + 12;
  EXPECT_EQ(0, std::memcmp(block.data() + points_at, tile.points->records.data(), 110));
}

TEST(Block, OfLabelsHasNoPoints) {
  const Tile tile = tile_of(some_points(100), std::vector<std::uint32_t>(100, 5));
  std::string block;
  append_block(tile, 0, 100, false, block);
  EXPECT_EQ(block.size(), kHeaderBytes + 4 + 100);
}

TEST(Block, IsCutOffAtTheEndOfTheTile) {
  const Tile tile = tile_of(some_points(10), std::vector<std::uint32_t>(10, 5));
  for (const auto& [first, count, expected] :
       {std::array{8U, 5U, 2U}, std::array{10U, 1U, 0U}, std::array{4'000'000'000U, 7U, 0U},
        std::array{1U, 4'294'967'295U, 9U}}) {
    std::string block;
    append_block(tile, first, count, true, block);
    EXPECT_EQ(word(block, 5), expected);
    EXPECT_LE(block.size(), max_block_bytes(expected) + 4);
  }
}

TEST(Block, TakesAtMostFifteenBytesAPoint) {
  constexpr int kPoints = 10'000;
  std::vector<std::uint32_t> ids(kPoints);
  for (std::uint32_t i = 0; i < kPoints; ++i) ids[i] = i % 300;
  std::string block;
  append_block(tile_of(some_points(kPoints), ids), 0, kPoints, true, block);
  EXPECT_LE(block.size(), 15U * kPoints);
}

}  // namespace
}  // namespace kintsugi::scene

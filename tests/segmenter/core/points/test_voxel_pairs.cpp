#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/points/point_cloud.hpp"
#include "segmenter/core/points/voxel_pairs.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Points = std::vector<CloudPoint>;

constexpr double kVoxel_m = 0.01;

/// At a place given in voxels.
CloudPoint at(double x, double y, double z) {
  return testing::make_point(kVoxel_m * x, kVoxel_m * y, kVoxel_m * z, 0, 0, 1);
}

TEST(VoxelPairs, ArePointsOfOneVoxelWhereverTheyStand) {
  const Points before = {at(0.5, 0.5, 0.5), at(5.5, 0.5, 0.5), at(-3.5, 7.5, 0.5)};
  const Points after = {at(-3.1, 7.1, 0.9), at(0.1, 0.9, 0.2), at(9.5, 0.5, 0.5)};
  EXPECT_THAT(pair_by_voxel(before, after, kVoxel_m),
              ElementsAre(PointPair{2, 0}, PointPair{0, 1}));
}

TEST(VoxelPairs, ArePointsThatCrossedAFace) {
  const Points before = {at(0.5, 0.5, 0.9), at(1.5, 0.5, 0.9), at(1.5, 0.5, 1.9)};
  const Points after = {at(0.5, 0.5, 1.1), at(1.5, 0.5, 1.1)};
  // The second has a point in its own voxel.
  EXPECT_THAT(pair_by_voxel(before, after, kVoxel_m),
              ElementsAre(PointPair{0, 0}, PointPair{2, 1}));
}

TEST(VoxelPairs, AreNoPointsFarApart) {
  EXPECT_THAT(pair_by_voxel(Points{at(0.5, 0.5, 0.5)}, Points{at(2.5, 0.5, 0.5)}, kVoxel_m),
              IsEmpty());
  // The voxel behind the farther face.
  EXPECT_THAT(pair_by_voxel(Points{at(0.5, 0.5, 0.5)}, Points{at(1.9, 0.5, 0.5)}, kVoxel_m),
              IsEmpty());
  EXPECT_THAT(pair_by_voxel(Points{}, Points{at(0.5, 0.5, 0.5)}, kVoxel_m), IsEmpty());
  EXPECT_THAT(pair_by_voxel(Points{at(0.5, 0.5, 0.5)}, Points{}, kVoxel_m), IsEmpty());
}

TEST(VoxelPairs, TakeEachPointOnceAndDoNotDependOnTheOrder) {
  std::mt19937 random(4);
  const auto coordinate = [&] { return (static_cast<double>(random() % 120) + 0.5) / 20.0; };
  for (int round = 0; round < 200; ++round) {
    Points before;
    Points after;
    std::set<std::array<int, 3>> is_taken;
    for (int k = 0; k < 60; ++k) {
      const double x = coordinate();
      const double y = coordinate();
      const double z = coordinate();
      Points& points = k % 2 == 0 ? before : after;
      const std::array voxel = {static_cast<int>(x) + 1000 * (k % 2), static_cast<int>(y),
                                static_cast<int>(z)};
      if (is_taken.insert(voxel).second) points.push_back(at(x, y, z));
    }
    const auto pairs_by_x = [&] {
      std::set<std::vector<float>> pairs;
      std::set<std::uint32_t> from;
      std::set<std::uint32_t> to;
      for (const PointPair& pair : pair_by_voxel(before, after, kVoxel_m)) {
        EXPECT_TRUE(from.insert(pair.before).second);
        EXPECT_TRUE(to.insert(pair.after).second);
        const CloudPoint& p = before.at(pair.before);
        const CloudPoint& q = after.at(pair.after);
        pairs.insert({p.x, p.y, p.z, q.x, q.y, q.z});
      }
      return pairs;
    };
    const auto expected = pairs_by_x();
    std::ranges::shuffle(before, random);
    std::ranges::shuffle(after, random);
    EXPECT_EQ(pairs_by_x(), expected);
  }
}

TEST(VoxelPairs, DecideWhichPointsOfAPatchMoved) {
  PointCloud cloud(kVoxel_m);
  const Points before = {at(0.5, 0.5, 0.5), at(1.5, 0.5, 0.5)};
  const Points after = {at(1.6, 0.5, 0.5), at(3.5, 0.5, 0.5), at(0.4, 0.5, 0.5)};
  cloud.add_slice(0, before, 0, PatchState::kInVolume);
  EXPECT_TRUE(cloud.slices()[0].is_in_volume());
  (void)cloud.take_change();
  cloud.replace_slice(0, after, 1, PatchState::kLeft);
  EXPECT_FALSE(cloud.slices()[0].is_in_volume());
  EXPECT_THAT(cloud.take_change().moved, ElementsAre(MovedPoint{1, 2}, MovedPoint{0, 4}));
  cloud.replace_slice(0, before, 2);  // no patch: by the place in the slice
  EXPECT_THAT(cloud.take_change().moved, ElementsAre(MovedPoint{2, 0}, MovedPoint{3, 1}));
}

}  // namespace
}  // namespace kintsugi::segmenter

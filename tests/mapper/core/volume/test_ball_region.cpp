// The ball of a TsdfVolume: what it holds, what leaves it and when.

#include <algorithm>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kRange_m = 0.8;
constexpr double kBlock_m = 0.08;

TsdfVolume::Config small_ball() { return {.max_range_m = kRange_m, .resolution_m = 0.01}; }

/// As little memory as there can be: 244 blocks.
TsdfVolume::Config frugal_ball() {
  TsdfVolume::Config config = small_ball();
  config.max_memory_mb = 1.0;
  return config;
}

BlockCoord block_at(const Eigen::Vector3d& p_W) {
  const Eigen::Vector3i block = (p_W / kBlock_m).array().floor().cast<int>();
  return make_block_coord(block.x(), block.y(), block.z());
}

Eigen::Vector3d random_vector(std::mt19937& random, double deviation) {
  std::normal_distribution<double> component(0.0, deviation);
  const double x = component(random);
  const double y = component(random);
  return {x, y, component(random)};
}

TEST(BallRegion, ContainsEverySurfaceInRangeOfTheCameraWithItsTruncationDistance) {
  std::mt19937 random(3);
  TsdfVolume volume(small_ball());
  Eigen::Vector3d camera_W = Eigen::Vector3d::Zero();
  for (int step = 0; step < 300; ++step) {
    camera_W += random_vector(random, 0.06);
    volume.shift_to(camera_W);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d direction = random_vector(random, 1.0).normalized();
      const Eigen::Vector3d farthest_W = camera_W + direction * (kRange_m + volume.truncation_m());
      ASSERT_TRUE(volume.contains(block_at(farthest_W))) << "step " << step;
    }
  }
}

TEST(BallRegion, HandsOutWhatLeavesOnce) {
  std::mt19937 random(4);
  TsdfVolume volume(small_ball());
  Eigen::Vector3d camera_W = Eigen::Vector3d::Zero();
  std::set<BlockCoord> held;
  for (int step = 0; step < 100; ++step) {
    camera_W += random_vector(random, 0.1);
    const std::vector<DetachedBlocks> slices = volume.shift_to(camera_W);
    ASSERT_LE(slices.size(), 1U);
    for (const DetachedBlocks& slice : slices) {
      EXPECT_TRUE(std::is_sorted(slice.coords.begin(), slice.coords.end()));
      for (const BlockCoord& coord : slice.coords) {
        ASSERT_FALSE(volume.contains(coord));
        ASSERT_EQ(held.erase(coord), 1U);
      }
    }
    for (const BlockCoord& coord : held) {
      ASSERT_TRUE(volume.contains(coord));
      ASSERT_NE(volume.find(coord), kNoBlock);
    }
    ASSERT_EQ(volume.num_blocks(), held.size());
    for (int i = 0; i < 50; ++i) {
      const BlockCoord coord = block_at(camera_W + random_vector(random, 0.4));
      if (!volume.contains(coord)) continue;
      volume.allocate(coord);
      held.insert(coord);
    }
  }
}

TEST(BallRegion, NamesTheSideOnWhichTheCameraIs) {
  TsdfVolume volume(small_ball());
  volume.allocate(make_block_coord(-10, 1, 2));
  EXPECT_EQ(volume.shift_to({1.0, 0.0, 0.0}).at(0).kind, SliceKind::kShiftPlusX);
  volume.allocate(make_block_coord(12, 1, 10));
  EXPECT_EQ(volume.shift_to({1.0, 0.0, -1.0}).at(0).kind, SliceKind::kShiftMinusZ);
}

/// A plate of 20 x 20 blocks around the camera.
void allocate_plate(TsdfVolume& volume) {
  for (int x = -10; x < 10; ++x) {
    for (int y = -10; y < 10; ++y) volume.allocate(make_block_coord(x, y, 0));
  }
}

TEST(BallRegion, LetsGoOfWhatWasOutOfViewForLongestWhenItIsTooFull) {
  TsdfVolume volume(frugal_ball());
  ASSERT_EQ(volume.max_blocks(), 244U);
  allocate_plate(volume);
  const auto see_from = [&volume](int lowest_x) {
    for (BlockSlot slot = 0; slot < volume.slots_end(); ++slot) {
      if (volume.in_use(slot) && volume.coord(slot).x >= lowest_x) volume.mark_seen(slot);
    }
  };
  EXPECT_TRUE(volume.shift_to({0, 0, 0}).empty()) << "all was in view since the call before";
  see_from(-6);
  EXPECT_EQ(volume.shift_to({0, 0, 0}).at(0).coords.size(), 244U / 16);
  for (int i = 0; i < 10; ++i) {
    see_from(-6);
    for (const DetachedBlocks& slice : volume.shift_to({0, 0, 0})) {
      for (const BlockCoord& coord : slice.coords) EXPECT_LT(coord.x, -6);
    }
  }
  EXPECT_EQ(volume.num_blocks(), 320U) << "what is in view stays, even if that is too much";
  for (int i = 0; i < 10; ++i) {
    see_from(5);
    for (const DetachedBlocks& slice : volume.shift_to({0, 0, 0})) {
      for (const BlockCoord& coord : slice.coords) EXPECT_LT(coord.x, 5);
    }
  }
  EXPECT_LE(volume.num_blocks(), 244U);
  EXPECT_GT(volume.num_blocks(), 244U / 16 * 15 - 1);
}

TEST(BallRegion, StartsEmptyWhereABlockLeftAndComesAgain) {
  TsdfVolume volume(frugal_ball());
  allocate_plate(volume);
  const BlockCoord coord = make_block_coord(-10, -10, 0);
  volume.voxels(volume.find(coord)).voxels[0] = 7;
  volume.shift_to({0, 0, 0});
  ASSERT_FALSE(volume.shift_to({0, 0, 0}).empty());
  ASSERT_EQ(volume.find(coord), kNoBlock) << "the first of those that were seen at the same time";
  EXPECT_EQ(volume.voxels(volume.allocate(coord)).voxels[0], 0U);
  const DetachedBlocks last = volume.detach_all();
  EXPECT_EQ(std::count(last.coords.begin(), last.coords.end(), coord), 1);
  EXPECT_EQ(std::count(last.apron_coords.begin(), last.apron_coords.end(), coord), 0);
  EXPECT_TRUE(last.bordering_coords.empty());
}

TEST(BallRegion, SaysHowFarItCanReach) {
  TsdfVolume::Config config = small_ball();
  config.max_range_m = TsdfVolume::longest_range_m(config);
  EXPECT_NEAR(config.max_range_m, 127 * kBlock_m, 0.5);
  EXPECT_LE(TsdfVolume(config).side_blocks(), 256);
  config.max_range_m += 0.01;
  EXPECT_THAT([&] { TsdfVolume volume(config); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("max_range_m is 9.")));
}

TEST(BallRegion, TakesBlocksBackAsTheyWere) {
  TsdfVolume volume(small_ball());
  volume.shift_to(Eigen::Vector3d::Zero());
  const BlockCoord here = make_block_coord(0, 0, 0);
  const BlockCoord beside = make_block_coord(1, 0, 0);
  for (const BlockCoord& coord : {here, beside}) {
    const BlockSlot slot = volume.allocate(coord);
    volume.voxels(slot).voxels.fill(0x00090000U + static_cast<Voxel>(coord.x));
    volume.colors(slot).colors.fill(0x01000000U + static_cast<VoxelColor>(coord.x));
  }
  const DetachedBlocks left = volume.detach_all(SliceKind::kPatch);
  ASSERT_EQ(left.coords, (std::vector{here, beside}));
  EXPECT_EQ(left.kind, SliceKind::kPatch);
  volume.shift_to(Eigen::Vector3d(1e-3, 0, 0));
  volume.voxels(volume.allocate(here)).voxels.fill(0x00020000U);  // is replaced

  volume.restore(std::vector{here}, std::vector{beside},
                 [&](std::size_t i, VoxelBlock& voxels, ColorBlock& colors) {
                   voxels = *left.voxels[i];
                   colors = *left.colors[i];
                 });
  EXPECT_EQ(volume.num_blocks(), 1U);
  const BlockSlot slot = volume.find(here);
  ASSERT_NE(slot, kNoBlock);
  EXPECT_EQ(volume.voxels(slot).voxels, left.voxels[0]->voxels);
  EXPECT_EQ(volume.colors(slot).colors, left.colors[0]->colors);
  const DetachedBlocks again = volume.detach_all();
  EXPECT_EQ(again.coords, std::vector{here});
  EXPECT_EQ(again.apron_coords, std::vector{beside}) << "to extract the surface between both";
}

TEST(BallRegion, LetsThoseAboutToLeaveBeChangedFirst) {
  TsdfVolume volume(small_ball());
  const BlockSlot first = volume.allocate(make_block_coord(0, 0, 0));
  volume.allocate(make_block_coord(1, 0, 0));
  const auto left = volume.shift_to(Eigen::Vector3d(50, 0, 0), [&](const auto& leaving) {
    EXPECT_EQ(leaving.size(), 2U);
    volume.discard(first);
  });
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left[0].coords, std::vector{make_block_coord(1, 0, 0)});
}

}  // namespace
}  // namespace kintsugi::mapper

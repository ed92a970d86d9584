#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

#include "mapper/core/slices/block_surface.hpp"
#include "mapper/core/slices/tile.hpp"
#include "tests/mapper/core/exact_volume.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kVoxel_m = 0.01;
const BlockCoord kBlock = make_block_coord(0, 0, 0);

/// What is known of a block when the plane z = `height_vox` passes through the volume.
BlockSurface surface_of_plane(double height_vox, int weight = 20,
                              const BlockCoord& block = kBlock) {
  const TsdfVolume volume = testing::exact_volume(
      0.5, kVoxel_m, weight,
      [&](const Eigen::Vector3d& p_W) { return p_W.z() - height_vox * kVoxel_m; });
  const CrossingRule rule(8, 4.0, volume.resolution_m(), volume.max_truncation_m());
  return {volume, volume.find(block), rule};
}

TEST(BlockSurface, HasOneVoxelForEachPlaceOnAPlane) {
  EXPECT_EQ(surface_of_plane(3.3).num_voxels(), 64);
  EXPECT_EQ(surface_of_plane(3.3, 8).num_voxels(), 0) << "no more observations than the threshold";
}

TEST(BlockSurface, BelongsToTheBlockOfTheNearerVoxel) {
  EXPECT_EQ(surface_of_plane(7.9).num_voxels(), 64);
  EXPECT_EQ(surface_of_plane(8.1).num_voxels(), 0);
  EXPECT_EQ(surface_of_plane(8.1, 20, make_block_coord(0, 0, 1)).num_voxels(), 64);
}

TEST(BlockSurface, HasALevelForEachFactorOfFourInObservations) {
  EXPECT_EQ(surface_of_plane(3.3, 9).level, 0);
  EXPECT_EQ(surface_of_plane(3.3, 31).level, 0);
  EXPECT_EQ(surface_of_plane(3.3, 32).level, 1);
  EXPECT_EQ(surface_of_plane(3.3, 127).level, 1);
  EXPECT_EQ(surface_of_plane(3.3, 128).level, 2);
}

/// The same from the definition: every pair of voxels side by side, one of which is in the block.
class SlowBlockSurface : public BlockSurface {
 public:
  SlowBlockSurface(const TsdfVolume& volume, const BlockCoord& block, const CrossingRule& rule) {
    const int first_level = 4 * rule.weight_threshold;
    std::array<int, 3> num_at_level{};
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = 0; i < kSide * kSide * kSide; ++i) {
        std::array<int, 3> lower = {i % kSide - 1, i / kSide % kSide - 1, i / kSide / kSide - 1};
        std::array<int, 3> upper = lower;
        ++upper[axis];
        if (num_outside(lower) + num_outside(upper) > 1 ||
            (num_outside(lower) == 1 && lower[axis] != -1))
          continue;
        const auto a = voxel_at(volume, block, lower);
        const auto b = voxel_at(volume, block, upper);
        if (voxel_weight(a) <= rule.weight_threshold || voxel_weight(b) <= rule.weight_threshold)
          continue;
        if ((voxel_distance_raw(a) < 0) == (voxel_distance_raw(b) < 0)) continue;
        const int own = std::abs(voxel_distance_raw(a));
        const int other = std::abs(voxel_distance_raw(b));
        if (own + other > rule.max_step_raw) continue;
        const auto& nearer = own > other ? upper : lower;
        voxels[(nearer[2] + 1) * kSide + nearer[1] + 1] |= 1U << (nearer[0] + 1);
        const int weight = std::min(voxel_weight(a), voxel_weight(b));
        ++num_at_level[weight >= 4 * first_level ? 2 : weight >= first_level ? 1 : 0];
        const std::array<int, 2> column = axis == 0   ? std::array{lower[1], lower[2]}
                                          : axis == 1 ? std::array{lower[0], lower[2]}
                                                      : std::array{lower[0], lower[1]};
        auto& place = places[(axis * kBlockSide + column[1]) * kBlockSide + column[0]];
        if (place == kNone)
          place =
              (lower[axis] + 1) * kUnitsPerVoxel + kUnitsPerVoxel * own / std::max(1, own + other);
      }
    }
    const int half = (num_at_level[0] + num_at_level[1] + num_at_level[2] + 1) / 2;
    if (num_at_level[1] + num_at_level[2] >= half) level = num_at_level[2] >= half ? 2 : 1;
  }

 private:
  static int num_outside(const std::array<int, 3>& place) {
    return std::ranges::count_if(place, [](int i) { return i < 0 || i >= kBlockSide; });
  }
  static Voxel voxel_at(const TsdfVolume& volume, const BlockCoord& block,
                        const std::array<int, 3>& place) {
    const auto block_of = [](int i) { return i < 0 ? -1 : i / kBlockSide; };
    const BlockSlot slot = volume.find(make_block_coord(
        block.x + block_of(place[0]), block.y + block_of(place[1]), block.z + block_of(place[2])));
    if (slot == kNoBlock) return 0;
    return volume.voxels(slot).voxels[voxel_index(place[0] & 7, place[1] & 7, place[2] & 7)];
  }
};

TEST(BlockSurface, IsWhatTheDefinitionSaysForRandomVoxels) {
  std::mt19937 random(7);
  TsdfVolume volume({.region = RegionShape::kCube, .volume_size_m = 0.5, .resolution_m = kVoxel_m});
  const CrossingRule rule(8, 4.0, volume.resolution_m(), volume.max_truncation_m());
  int num_voxels = 0;
  for (int round = 0; round < 40; ++round) {
    for (int i = 0; i < 27; ++i) {
      const BlockCoord coord = make_block_coord(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      // Some of the blocks around are missing in some rounds.
      if (volume.find(coord) == kNoBlock && (coord == kBlock || random() % 8 == 0))
        volume.allocate(coord);
      if (volume.find(coord) == kNoBlock) continue;
      for (Voxel& voxel : volume.voxels(volume.find(coord)).voxels) {
        const Voxel weight = random() % 4 == 0 ? random() % 10 : random() % 200;
        const int raw = static_cast<int>(random() % 24'001) - 12'000;
        voxel = weight << 16U | static_cast<std::uint16_t>(raw);
      }
    }
    const BlockSurface fast(volume, volume.find(kBlock), rule);
    const SlowBlockSurface slow(volume, kBlock, rule);
    ASSERT_EQ(fast.voxels, slow.voxels) << round;
    ASSERT_EQ(fast.places, slow.places) << round;
    ASSERT_EQ(fast.level, slow.level) << round;
    num_voxels += fast.num_voxels();
  }
  EXPECT_GT(num_voxels, 1'000);
}

TEST(BlockChange, IsNoneForAPlaneThatHardlyMoves) {
  const BlockChange change = change_between(surface_of_plane(3.3), surface_of_plane(3.5));
  EXPECT_EQ(change.num_new, 0);
  EXPECT_EQ(change.num_better, 0);
  EXPECT_EQ(change.num_in_all, 64);
}

TEST(BlockChange, IsBetterWhereThePlaneMovedByMoreThanAQuarterOfAVoxel) {
  for (const double to : {3.6, 2.9, 4.2}) {
    const BlockChange change = change_between(surface_of_plane(3.3), surface_of_plane(to));
    EXPECT_EQ(change.num_new, 0) << to;
    EXPECT_EQ(change.num_better, change.num_in_all) << to;
  }
}

TEST(BlockChange, IsBetterWhereItWasObservedFourTimesAsOften) {
  EXPECT_EQ(change_between(surface_of_plane(3.3, 9), surface_of_plane(3.3, 40)).num_better, 64);
  EXPECT_EQ(change_between(surface_of_plane(3.3, 40), surface_of_plane(3.3, 60)).num_better, 0);
}

TEST(BlockChange, IsNewWhereNothingWasWithinAVoxel) {
  EXPECT_EQ(change_between(BlockSurface(), surface_of_plane(3.3)).num_new, 64);
  EXPECT_EQ(change_between(surface_of_plane(3.3), BlockSurface()).num_new, 64);
  EXPECT_EQ(change_between(surface_of_plane(1.3), surface_of_plane(5.3)).num_new, 128);
}

TEST(BlockChange, OfAPlaneThatSlipsIntoTheNextBlockIsNotNew) {
  for (const int z : {0, 1}) {
    const BlockCoord block = make_block_coord(0, 0, z);
    const BlockChange change =
        change_between(surface_of_plane(7.95, 20, block), surface_of_plane(8.05, 20, block));
    EXPECT_EQ(change.num_new, 0) << z;
  }
}

TEST(TileGrid, HasWholeBlocksAndNoDoubleTileAtTheOrigin) {
  const TileGrid grid(0.5, 0.01);  // 8 cm blocks
  EXPECT_EQ(grid.side_blocks(), 6);
  EXPECT_EQ(grid.tile_of(make_block_coord(0, 5, 6)), (TileCoord{.z = 1, .y = 0, .x = 0}));
  EXPECT_EQ(grid.tile_of(make_block_coord(-1, -6, -7)), (TileCoord{.z = -2, .y = -1, .x = -1}));
  int count = 0;
  grid.for_each_block({.z = -2, .y = 0, .x = 3}, [&](const BlockCoord& block) {
    EXPECT_EQ(grid.tile_of(block), (TileCoord{.z = -2, .y = 0, .x = 3}));
    ++count;
  });
  EXPECT_EQ(count, 216);
  EXPECT_EQ(TileGrid(0.5, 1.0).side_blocks(), 1) << "at least a block";
}

}  // namespace
}  // namespace kintsugi::mapper

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

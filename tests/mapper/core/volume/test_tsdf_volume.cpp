#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kBlock_m = 0.08;

/// 10 blocks a side: not a power of two, so that the table is larger than the cube.
TsdfVolume::Config ten_blocks() {
  return {
      .region = RegionShape::kCube, .volume_size_m = 0.8, .resolution_m = 0.01, .shift_vox = 14};
}

/// What the volume ought to be: blocks by coordinate, each with its own mark.
using Reference = std::map<BlockCoord, Voxel>;

Voxel& mark_of(TsdfVolume& volume, const BlockCoord& coord) {
  return volume.voxels(volume.find(coord)).voxels[0];
}

void expect_same(TsdfVolume& volume, const Reference& reference) {
  EXPECT_EQ(volume.num_blocks(), reference.size());
  const BlockCoord& min = volume.min_block();
  for (int z = -2; z < volume.side_blocks() + 2; ++z) {
    for (int y = -2; y < volume.side_blocks() + 2; ++y) {
      for (int x = -2; x < volume.side_blocks() + 2; ++x) {
        const BlockCoord coord = make_block_coord(min.x + x, min.y + y, min.z + z);
        const auto expected = reference.find(coord);
        ASSERT_EQ(volume.find(coord) != kNoBlock, expected != reference.end());
        if (expected != reference.end()) {
          ASSERT_EQ(mark_of(volume, coord), expected->second);
        }
      }
    }
  }
}

TEST(TsdfVolume, HoldsWhatAMapWouldHoldUnderRandomShifts) {
  std::mt19937 random(7);
  TsdfVolume volume(ten_blocks());
  Reference reference;
  Eigen::Vector3d camera_W = Eigen::Vector3d::Zero();
  std::uniform_int_distribution<int> cell(0, volume.side_blocks() - 1);
  std::normal_distribution<double> step_m(0.0, 0.2);  // often more than the threshold
  Voxel next_mark = 1;
  for (int round = 0; round < 60; ++round) {
    for (int i = 0; i < 40; ++i) {
      const BlockCoord& min = volume.min_block();
      const BlockCoord coord =
          make_block_coord(min.x + cell(random), min.y + cell(random), min.z + cell(random));
      volume.allocate(coord);
      mark_of(volume, coord) = reference[coord] = next_mark++;
    }
    camera_W += Eigen::Vector3d(step_m(random), step_m(random), step_m(random));
    for (const DetachedBlocks& slice : volume.shift_to(camera_W)) {
      for (std::size_t i = 0; i < slice.coords.size(); ++i) {
        const auto expected = reference.find(slice.coords[i]);
        ASSERT_NE(expected, reference.end());
        EXPECT_EQ(slice.voxels[i]->voxels[0], expected->second);
        reference.erase(expected);
      }
    }
    for (const auto& [coord, mark] : reference) ASSERT_TRUE(volume.contains(coord));
    expect_same(volume, reference);
  }
}

TEST(TsdfVolume, StaysUntilTheCameraIsBeyondTheThreshold) {
  TsdfVolume volume(ten_blocks());
  const BlockCoord before = volume.min_block();
  volume.shift_to({0.139, -0.139, 0.139});
  EXPECT_EQ(volume.min_block(), before);
}

TEST(TsdfVolume, MovesToWithinHalfABlockOfTheCamera) {
  TsdfVolume volume(ten_blocks());
  for (const Eigen::Vector3d& camera_W :
       {Eigen::Vector3d(0.15, -0.15, 0.5), Eigen::Vector3d(-7.0, 3.3, 900.0)}) {
    volume.shift_to(camera_W);
    EXPECT_LE((volume.center_W() - camera_W).cwiseAbs().maxCoeff(), kBlock_m / 2 + 1e-9);
  }
}

TEST(TsdfVolume, CanBeCenteredAnewAlsoWithinTheThreshold) {
  TsdfVolume volume(ten_blocks());
  const Eigen::Vector3d near_W(0.5 * kBlock_m, -0.5 * kBlock_m, 900.0);
  volume.center_at(near_W);
  EXPECT_EQ(volume.center_W(), TsdfVolume(ten_blocks(), near_W).center_W());
}

TEST(TsdfVolume, NamesTheDirectionInWhichItMoved) {
  TsdfVolume volume(ten_blocks());
  const auto fill = [&volume] {
    const BlockCoord& min = volume.min_block();
    for (int i = 0; i < volume.side_blocks(); ++i) {
      volume.allocate(make_block_coord(min.x + i, min.y + i, min.z + i));
    }
  };
  fill();
  std::vector<SliceKind> kinds;
  const auto shift = [&](const Eigen::Vector3d& camera_W) {
    for (const DetachedBlocks& slice : volume.shift_to(camera_W)) kinds.push_back(slice.kind);
    fill();
  };
  shift({0.16, 0.0, 0.0});
  shift({0.16, -0.16, 0.0});
  shift({0.16, -0.16, 0.16});
  shift({0.0, -0.16, 0.16});
  shift({0.0, 0.0, 0.16});
  shift({0.0, 0.0, 0.0});
  EXPECT_THAT(kinds, ::testing::ElementsAre(SliceKind::kShiftPlusX, SliceKind::kShiftMinusY,
                                            SliceKind::kShiftPlusZ, SliceKind::kShiftMinusX,
                                            SliceKind::kShiftPlusY, SliceKind::kShiftMinusZ));
}

TEST(TsdfVolume, HandsOutWhatLeavesOnceAndInOrder) {
  TsdfVolume volume(ten_blocks());
  const BlockCoord min = volume.min_block();
  for (int z = 0; z < 10; z += 3) {
    for (int x = 9; x >= 0; --x) volume.allocate(make_block_coord(min.x + x, min.y, min.z + z));
  }
  const std::vector<DetachedBlocks> slices = volume.shift_to({0.16, 0.0, 0.0});
  ASSERT_EQ(slices.size(), 1U);
  EXPECT_EQ(slices[0].coords.size(), 8U);
  EXPECT_TRUE(std::is_sorted(slices[0].coords.begin(), slices[0].coords.end()));
  EXPECT_EQ(slices[0].voxels.size(), 8U);
  EXPECT_EQ(slices[0].colors.size(), 8U);
  EXPECT_EQ(volume.num_blocks(), 32U);
}

TEST(TsdfVolume, GivesASliceTheBlocksAroundIt) {
  TsdfVolume volume(ten_blocks());
  const BlockCoord min = volume.min_block();
  for (int x = 0; x < 10; ++x) {
    const BlockCoord coord = make_block_coord(min.x + x, min.y + 5, min.z + 5);
    volume.allocate(coord);
    mark_of(volume, coord) = static_cast<Voxel>(100 + x);
  }
  const auto mark = [&](const DetachedBlocks& slice, int x) -> Voxel {
    const VoxelBlock* block = slice.find(make_block_coord(min.x + x, min.y + 5, min.z + 5));
    return block == nullptr ? 0 : block->voxels[0];
  };
  const DetachedBlocks first = volume.shift_to({0.16, 0.0, 0.0}).at(0);
  EXPECT_EQ(mark(first, 2), 102U) << "still in the volume";
  EXPECT_EQ(mark(first, 3), 0U) << "does not touch the slice";
  EXPECT_EQ(first.apron_coords.size(), 1U);
  const DetachedBlocks second = volume.shift_to({0.32, 0.0, 0.0}).at(0);
  EXPECT_EQ(mark(second, 1), 101U) << "left before";
  EXPECT_EQ(mark(second, 4), 104U) << "still in the volume";
  EXPECT_EQ(second.apron_coords.size(), 2U);
}

TEST(TsdfVolume, StartsEmptyWhereItComesBack) {
  TsdfVolume volume(ten_blocks());
  const BlockCoord corner = volume.min_block();
  volume.allocate(corner);
  mark_of(volume, corner) = 5;
  volume.shift_to({0.16, 0.0, 0.0});
  volume.shift_to({0.0, 0.0, 0.0});
  ASSERT_TRUE(volume.contains(corner));
  EXPECT_EQ(volume.find(corner), kNoBlock);
  volume.allocate(corner);
  EXPECT_EQ(mark_of(volume, corner), 0U);
  EXPECT_TRUE(volume.snapshot().apron_coords.empty());
}

TEST(TsdfVolume, RecyclesMemory) {
  TsdfVolume volume(ten_blocks());
  const auto fill_and_leave = [&volume](int round) {
    const BlockCoord& min = volume.min_block();
    for (int i = 0; i < 10; ++i) volume.allocate(make_block_coord(min.x + i, min.y, min.z));
    volume.shift_to({2.0 * round, 0.0, 0.0});
  };
  fill_and_leave(1);
  const std::size_t once = volume.memory_bytes();
  for (int round = 2; round < 1000; ++round) fill_and_leave(round);
  EXPECT_EQ(volume.memory_bytes(), once);
  EXPECT_EQ(volume.num_blocks(), 0U);
}

/// Allocates the walls of a straight corridor along x, as far as the cube reaches.
void allocate_corridor(TsdfVolume& volume) {
  const BlockCoord& min = volume.min_block();
  for (int x = 0; x < volume.side_blocks(); ++x) {
    for (int z = 0; z < volume.side_blocks(); ++z) {
      volume.allocate(make_block_coord(min.x + x, -3, min.z + z));
      volume.allocate(make_block_coord(min.x + x, 2, min.z + z));
    }
  }
}

TEST(TsdfVolume, KeepsItsMemoryOnAWalkOfAnyLength) {
  TsdfVolume volume(ten_blocks());
  std::deque<DetachedBlocks> waiting;  // for extraction
  constexpr std::size_t kMaxWaiting = 3;
  std::size_t bytes_after_20 = 0;
  for (int step = 1; step <= 5000; ++step) {  // 800 m, a thousand times the cube
    allocate_corridor(volume);
    for (DetachedBlocks& slice : volume.shift_to({0.16 * step, 0.0, 0.0})) {
      ASSERT_EQ(slice.coords.size(), 40U);
      waiting.push_back(std::move(slice));
    }
    while (waiting.size() > kMaxWaiting) waiting.pop_front();
    if (step == 20) bytes_after_20 = volume.memory_bytes();
  }
  EXPECT_EQ(volume.memory_bytes(), bytes_after_20);
  // The cube, three slices of two layers with a layer to either side: 4 KB a block, and the table.
  constexpr std::size_t kBlocks = 200 + 3 * 80;
  constexpr std::size_t kTable = std::size_t{16} * 16 * 16 * sizeof(BlockSlot);
  constexpr std::size_t kHugePages = 2 * (std::size_t{2} << 20U);  // memory comes in these
  EXPECT_LE(volume.memory_bytes(), 2 * kBlocks * 4096 + kTable + kHugePages);
}

TEST(TsdfVolume, LeavesASliceAsItLeftWhateverBecomesOfTheVolume) {
  std::vector<DetachedBlocks> slices;
  {
    TsdfVolume volume(ten_blocks());
    allocate_corridor(volume);
    for (BlockSlot slot = 0; slot < volume.slots_end(); ++slot) {
      volume.voxels(slot).voxels.fill(static_cast<Voxel>(1000 + volume.coord(slot).x));
    }
    for (int step = 1; step <= 8; ++step) {
      for (DetachedBlocks& slice : volume.shift_to({0.16 * step, 0.0, 0.0})) {
        slices.push_back(std::move(slice));
      }
      allocate_corridor(volume);  // recycles what it can
      for (BlockSlot slot = 0; slot < volume.slots_end(); ++slot) {
        if (volume.in_use(slot)) volume.voxels(slot).voxels[5] = 1;
      }
    }
  }
  ASSERT_EQ(slices.size(), 8U);
  for (std::size_t i = 0; i < slices[0].coords.size(); ++i) {
    const auto mark = static_cast<Voxel>(1000 + slices[0].coords[i].x);
    EXPECT_EQ(slices[0].voxels[i]->voxels[5], mark);
    EXPECT_EQ(slices[0].voxels[i]->voxels[6], mark);
  }
  for (std::size_t i = 0; i < slices[0].apron_coords.size(); ++i) {
    EXPECT_EQ(slices[0].apron_voxels[i]->voxels[5],
              static_cast<Voxel>(1000 + slices[0].apron_coords[i].x));
  }
}

TEST(TsdfVolume, TellsWhichNeighboursStay) {
  TsdfVolume volume(ten_blocks());
  allocate_corridor(volume);
  const DetachedBlocks first = volume.shift_to({0.16, 0.0, 0.0}).at(0);
  EXPECT_EQ(first.bordering_coords.size(), 20U) << "the outer of two layers is out of reach";
  EXPECT_EQ(first.apron_coords.size(), 20U);
  for (const ColorBlock* colors : first.apron_colors) EXPECT_EQ(colors, nullptr);
  const DetachedBlocks second = volume.shift_to({0.32, 0.0, 0.0}).at(0);
  EXPECT_EQ(second.apron_coords.size(), 40U);
  for (std::size_t i = 0; i < second.apron_coords.size(); ++i) {
    EXPECT_EQ(second.apron_colors[i] == nullptr, volume.contains(second.apron_coords[i]));
  }
  const DetachedBlocks last = volume.detach_all();
  EXPECT_TRUE(last.bordering_coords.empty());
  for (const ColorBlock* colors : last.apron_colors) EXPECT_NE(colors, nullptr);
}

TEST(TsdfVolume, EndsWithAFinalSliceOfEverything) {
  TsdfVolume volume(ten_blocks());
  volume.allocate(make_block_coord(0, 0, 0));
  volume.allocate(make_block_coord(1, 2, 3));
  const DetachedBlocks seen = volume.snapshot();
  EXPECT_EQ(volume.num_blocks(), 2U);
  const DetachedBlocks last = volume.detach_all();
  EXPECT_EQ(last.kind, SliceKind::kFinal);
  EXPECT_EQ(last.coords, seen.coords);
  EXPECT_EQ(last.coords.size(), 2U);
  EXPECT_EQ(volume.num_blocks(), 0U);
  EXPECT_EQ(volume.find(make_block_coord(0, 0, 0)), kNoBlock);
  EXPECT_TRUE(volume.detach_all().coords.empty());
}

TEST(TsdfVolume, RoundsTheCubeUpToWholeBlocks) {
  EXPECT_EQ(TsdfVolume({.region = RegionShape::kCube}).side_blocks(), 64);
  EXPECT_EQ(TsdfVolume({.region = RegionShape::kCube, .volume_size_m = 4.5, .resolution_m = 0.01})
                .side_blocks(),
            57);
  EXPECT_EQ(
      TsdfVolume({.region = RegionShape::kCube, .volume_size_m = 6.0, .resolution_m = 6.0 / 512})
          .side_blocks(),
      64);
}

TEST(TsdfVolume, RefusesAConfigurationThatCannotWork) {
  const auto refusal = [](const TsdfVolume::Config& config) {
    return [config] { TsdfVolume volume(config); };
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal({.resolution_m = 0.0}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("resolution_m is 0")));
  EXPECT_THAT(refusal({.region = RegionShape::kCube, .volume_size_m = kNan}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("volume_size_m is nan")));
  EXPECT_THAT(refusal({.region = RegionShape::kCube, .volume_size_m = -1.0}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("volume_size_m is -1")));
  EXPECT_THAT(refusal({.region = RegionShape::kCube, .volume_size_m = 90.0, .resolution_m = 0.001}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("side in blocks")));
  EXPECT_THAT(refusal({.truncation_vox = 1.0}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("truncation_vox is 1")));
  EXPECT_THAT(refusal({.max_weight = 0}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("max_weight is 0")));
  EXPECT_THAT(refusal({.max_weight = 65536}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("within [1, 65535]")));
  EXPECT_THAT(refusal({.region = RegionShape::kCube, .shift_vox = 7}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("shift_vox is 7")));
  EXPECT_THAT(refusal({.region = RegionShape::kCube, .shift_vox = 256}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("shift_vox is 256")));
}

TEST(TsdfVolume, RefusesAPositionThatIsNowhereAndStaysAsItWas) {
  TsdfVolume volume(ten_blocks());
  volume.allocate(make_block_coord(0, 0, 0));
  const BlockCoord before = volume.min_block();
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e9}) {
    EXPECT_THROW(volume.shift_to({1.0, bad, 0.0}), std::invalid_argument);
  }
  EXPECT_EQ(volume.min_block(), before);
  EXPECT_EQ(volume.num_blocks(), 1U);
}

}  // namespace
}  // namespace kintsugi::mapper

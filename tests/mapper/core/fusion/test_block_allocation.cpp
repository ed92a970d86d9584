#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/core/frame/camera.hpp"
#include "mapper/core/fusion/block_allocation.hpp"
#include "mapper/core/kernels/instruction_set.hpp"
#include "tests/mapper/core/scene_fusion.hpp"

namespace kintsugi::mapper {
namespace {

using testing::View;

constexpr float kMinDepth_m = 0.4F;
constexpr float kMaxDepth_m = 3.0F;

/// A room larger than the cube, with every kind of bad depth.
View torn_view() {
  const auto room = synthetic::make_scene_with_path("box-room");
  View view = testing::make_view(room.scene, room.trajectory.X_WC(1.0));
  cv::Mat_<float>& depth_m = view.frame.depth_m;
  depth_m.colRange(0, 20).setTo(std::numeric_limits<float>::quiet_NaN());
  depth_m.colRange(20, 30).setTo(std::numeric_limits<float>::infinity());
  depth_m.colRange(30, 40).setTo(-1.0F);
  depth_m.colRange(40, 50).setTo(0.39F);
  depth_m.colRange(50, 60).setTo(3.01F);
  return view;
}

/// Before the camera; some of what it sees is inside.
TsdfVolume cube_in(const View& view) {
  return TsdfVolume({.region = RegionShape::kCube, .volume_size_m = 2.5, .resolution_m = 0.01},
                    view.X_WC * Eigen::Vector3d(0.5, 0.0, 2.0));
}

std::vector<BlockCoord> allocate(const View& view, InstructionSet instruction_set,
                                 TsdfVolume& volume) {
  allocate_seen_blocks(view.frame.depth_m, pinhole_camera(view.frame.intrinsics), view.X_WC,
                       kMinDepth_m, kMaxDepth_m, kernels_for(instruction_set), volume);
  std::vector<BlockCoord> coords;
  coords.reserve(static_cast<std::size_t>(volume.slots_end()));
  for (BlockSlot slot = 0; slot < volume.slots_end(); ++slot) coords.push_back(volume.coord(slot));
  return coords;
}

/// Single precision may put a point so close to a block's face on its other side.
constexpr double kRounding_blocks = 1e-5;

struct Expected {
  std::set<BlockCoord> certain;
  std::set<BlockCoord> possible;
};

/// At the depth of every other pixel and a truncation distance before and behind it (half a block
/// here), in double precision.
Expected walk_slowly(const View& view, const TsdfVolume& volume) {
  const double block_m = volume.config().resolution_m * kBlockSide;
  const Intrinsics& camera = view.frame.intrinsics;
  Expected blocks;
  const auto block_at = [](const Eigen::Vector3d& p) {
    return make_block_coord(static_cast<int>(std::floor(p.x())),
                            static_cast<int>(std::floor(p.y())),
                            static_cast<int>(std::floor(p.z())));
  };
  const auto add = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(kRounding_blocks);
    const BlockCoord low = block_at(p - reach);
    const BlockCoord high = block_at(p + reach);
    if (low == high && volume.contains(low)) blocks.certain.insert(low);
    for (int corner = 0; corner < 8; ++corner) {
      const BlockCoord coord =
          make_block_coord((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                           (corner & 4) != 0 ? high.z : low.z);
      if (volume.contains(coord)) blocks.possible.insert(coord);
    }
  };
  for (int v = 0; v < camera.height; v += 2) {
    for (int u = 0; u < camera.width; u += 2) {
      const double depth_m = view.frame.depth_m(v, u);
      if (!(depth_m >= kMinDepth_m && depth_m <= kMaxDepth_m)) continue;
      const Eigen::Vector3d ray_C((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
      for (const double from_depth_m : {-0.04, 0.0, 0.04}) {
        add(view.X_WC * (ray_C * (depth_m + from_depth_m)) / block_m);
      }
    }
  }
  return blocks;
}

class BlockAllocation : public ::testing::TestWithParam<InstructionSet> {
 protected:
  void SetUp() override {
    if (!is_supported(GetParam())) GTEST_SKIP() << "not on this processor";
  }
};

TEST_P(BlockAllocation, FindsTheBlocksAlongTheRays) {
  const View view = torn_view();
  TsdfVolume volume = cube_in(view);
  const std::vector<BlockCoord> allocated = allocate(view, GetParam(), volume);
  const Expected expected = walk_slowly(view, volume);
  ASSERT_GT(expected.certain.size(), 500U);
  const std::set<BlockCoord> actual(allocated.begin(), allocated.end());
  EXPECT_TRUE(std::includes(actual.begin(), actual.end(), expected.certain.begin(),
                            expected.certain.end()));
  EXPECT_TRUE(std::includes(expected.possible.begin(), expected.possible.end(), actual.begin(),
                            actual.end()));
}

TEST_P(BlockAllocation, GivesTheSlotsOfThePortableOne) {
  const View view = torn_view();
  TsdfVolume volume = cube_in(view);
  TsdfVolume portable = cube_in(view);
  EXPECT_EQ(allocate(view, GetParam(), volume),
            allocate(view, InstructionSet::kPortable, portable));
}

TEST_P(BlockAllocation, AddsNothingTheSecondTime) {
  const View view = torn_view();
  TsdfVolume volume = cube_in(view);
  const std::size_t before = allocate(view, GetParam(), volume).size();
  EXPECT_EQ(allocate(view, GetParam(), volume).size(), before);
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, BlockAllocation, ::testing::ValuesIn(kInstructionSets),
                         [](const auto& info) { return std::string(name_of(info.param)); });

}  // namespace
}  // namespace kintsugi::mapper

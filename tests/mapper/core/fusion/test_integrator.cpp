#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "mapper/core/fusion/integrator.hpp"
#include "mapper/core/kernels/instruction_set.hpp"
#include "tests/mapper/core/scene_fusion.hpp"

namespace kintsugi::mapper {
namespace {

using testing::fuse;
using ::testing::HasSubstr;
using testing::percentile;
using ::testing::ThrowsMessage;
using testing::View;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kResolution_m = 0.01;

TsdfVolume::Config volume_of(double size_m) {
  return {.region = RegionShape::kCube, .volume_size_m = size_m, .resolution_m = kResolution_m};
}

bool same_bytes(const DetachedBlocks& a, const DetachedBlocks& b) {
  if (a.coords != b.coords) return false;
  for (std::size_t i = 0; i < a.coords.size(); ++i) {
    if (a.voxels[i]->voxels != b.voxels[i]->voxels) return false;
    if (a.colors[i]->colors != b.colors[i]->colors) return false;
  }
  return true;
}

/// A wall across the view.
View wall_view(float depth_m) {
  const Intrinsics camera = testing::small_camera();
  View view;
  view.frame.intrinsics = camera;
  view.frame.depth_m = cv::Mat_<float>(camera.height, camera.width, depth_m);
  view.frame.color_rgb = cv::Mat_<cv::Vec3b>(camera.height, camera.width, cv::Vec3b(10, 20, 30));
  return view;
}

template <typename Function>
void for_each_voxel(const DetachedBlocks& blocks, Function function) {
  for (std::size_t block = 0; block < blocks.coords.size(); ++block) {
    const BlockCoord& coord = blocks.coords[block];
    const Eigen::Vector3d corner_vox = kBlockSide * Eigen::Vector3d(coord.x, coord.y, coord.z);
    for (int i = 0; i < kBlockVoxels; ++i) {
      const Eigen::Vector3d center_vox = Eigen::Vector3d(i & 7, (i >> 3) & 7, i >> 6).array() + 0.5;
      function(Eigen::Vector3d((corner_vox + center_vox) * kResolution_m),
               blocks.voxels[block]->voxels[i]);
    }
  }
}

TEST(Integrator, MeasuresTheDistanceFieldOfARoom) {
  const auto scene = synthetic::make_scene_with_path("box-room");
  const std::vector<View> views = testing::views_along_path(scene, 40);
  TsdfVolume volume(volume_of(4.8), {0.0, 0.0, 1.25});  // holds the whole room
  fuse(views, volume);

  std::vector<double> shortfall_vox;
  std::vector<double> error_vox;
  int num_wrong_side = 0;
  int num_compared = 0;
  for_each_voxel(volume.snapshot(), [&](const Eigen::Vector3d& p_W, Voxel voxel) {
    if (voxel_weight(voxel) <= 8 || std::abs(voxel_distance(voxel)) > 0.9F) return;
    const double truth_vox = scene.scene.signed_distance(p_W) / kResolution_m;
    const double fused_vox = voxel_distance(voxel) * volume.config().truncation_vox;
    if (std::abs(truth_vox) > 3.0) return;
    ++num_compared;
    error_vox.push_back(std::abs(fused_vox - truth_vox));
    if (truth_vox > 0.0) shortfall_vox.push_back(truth_vox - fused_vox);
    if (std::abs(truth_vox) > 0.5 && truth_vox * fused_vox < 0.0) ++num_wrong_side;
  });
  ASSERT_GT(num_compared, 100000);
  // Along a pixel's ray there is a surface at the measured depth, so in free space the true
  // distance is at most the distance along the ray: what is stored, times the ray's length per
  // metre of depth (1.26 in the image's corner). Half a pixel's slant is the rest.
  EXPECT_LT(percentile(shortfall_vox, 0.99), 0.26 * 3.0);
  EXPECT_LT(percentile(shortfall_vox, 0.5), 0.05);
  // The other way, a projective distance is too large by 1 / cos(angle of incidence).
  EXPECT_LT(percentile(error_vox, 0.5), 0.5);
  EXPECT_LT(static_cast<double>(num_wrong_side) / num_compared, 0.01);
}

TEST(Integrator, GivesTheSameBytesWithAnyNumberOfThreads) {
  const auto scene = synthetic::make_scene("sphere");
  const std::vector<View> views = testing::views_around(scene, 1.3, {0.3}, 4);
  TsdfVolume parallel(volume_of(1.6));
  fuse(views, parallel);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  TsdfVolume serial(volume_of(1.6));
  fuse(views, serial);
  ASSERT_GT(serial.num_blocks(), 500U);
  EXPECT_TRUE(same_bytes(parallel.snapshot(), serial.snapshot()));
  for (BlockSlot slot = 0; slot < serial.slots_end(); ++slot) {
    ASSERT_EQ(parallel.coord(slot), serial.coord(slot));
  }
}

TEST(Integrator, GivesTheSameBytesInEveryInstructionSet) {
  const auto scene = synthetic::make_scene("sphere");
  const std::vector<View> views = testing::views_around(scene, 1.3, {0.3}, 4);
  TsdfVolume portable(volume_of(1.6));
  fuse(views, portable, {.instruction_set = InstructionSet::kPortable});
  for (const InstructionSet instruction_set : kInstructionSets) {
    if (!is_supported(instruction_set)) continue;
    TsdfVolume volume(volume_of(1.6));
    fuse(views, volume, {.instruction_set = instruction_set});
    EXPECT_TRUE(same_bytes(portable.snapshot(), volume.snapshot())) << name_of(instruction_set);
  }
}

TEST(Integrator, AllocatesTheTruncationBandAndNoMore) {
  TsdfVolume volume(volume_of(3.2), {0.0, 0.0, 1.0});
  constexpr float kDepth_m = 1.02F;
  fuse({wall_view(kDepth_m)}, volume);
  ASSERT_GT(volume.num_blocks(), 0U);
  const DetachedBlocks blocks = volume.snapshot();
  for (const BlockCoord& coord : blocks.coords) {
    ASSERT_GT((coord.z + 1) * kBlockSide * kResolution_m, kDepth_m - 0.041);
    ASSERT_LT(coord.z * kBlockSide * kResolution_m, kDepth_m + 0.041);
  }
  // Every voxel in the view within 3 of the wall was seen, whichever pixels the blocks came from.
  for (int z = 99; z < 105; ++z) {
    for (int x = -50; x < 50; ++x) {
      const BlockSlot slot = volume.find(make_block_coord(x >> 3, 0, z >> 3));
      ASSERT_NE(slot, kNoBlock);
      const Voxel voxel = volume.voxels(slot).voxels[voxel_index(x & 7, 0, z & 7)];
      EXPECT_EQ(voxel_weight(voxel), 1);
      EXPECT_NEAR(voxel_distance(voxel) * 4, 102 - (z + 0.5), 1e-2);
    }
  }
}

TEST(Integrator, CarvesWhatTurnsOutToBeFree) {
  TsdfVolume volume(volume_of(3.2), {0.0, 0.0, 1.0});
  fuse({wall_view(1.0F)}, volume);
  const std::vector<View> farther(20, wall_view(1.5F));
  fuse(farther, volume);
  for_each_voxel(volume.snapshot(), [&](const Eigen::Vector3d& p_W, Voxel voxel) {
    if (p_W.z() < 1.4 && voxel_weight(voxel) > 20) {
      ASSERT_GT(voxel_distance(voxel), 0.8F);
    }
  });
}

TEST(Integrator, DoesNothingWithAnEmptyFrame) {
  for (const float depth_m : {kNan, 0.0F, -1.0F, std::numeric_limits<float>::infinity()}) {
    TsdfVolume volume(volume_of(3.2));
    fuse({wall_view(depth_m)}, volume);
    EXPECT_EQ(volume.num_blocks(), 0U) << depth_m;
    fuse({wall_view(1.0F)}, volume);
    const DetachedBlocks before = volume.snapshot();
    fuse({wall_view(depth_m)}, volume);
    EXPECT_TRUE(same_bytes(volume.snapshot(), before)) << depth_m;
  }
}

TEST(Integrator, IgnoresDepthsOutOfItsRange) {
  TsdfVolume volume(volume_of(3.2));
  const Integrator::Config config{.min_depth_m = 0.5, .max_depth_m = 1.2};
  fuse({wall_view(0.49F), wall_view(1.21F)}, volume, config);
  EXPECT_EQ(volume.num_blocks(), 0U);
  fuse({wall_view(0.51F), wall_view(1.19F)}, volume, config);
  EXPECT_GT(volume.num_blocks(), 0U);
}

TEST(Integrator, SeesTheCubeFromOutside) {
  TsdfVolume volume(volume_of(0.64), {0.0, 0.0, 2.0});
  fuse({wall_view(2.0F)}, volume);
  EXPECT_GT(volume.num_blocks(), 0U);
  for (const BlockCoord& coord : volume.snapshot().coords) EXPECT_TRUE(volume.contains(coord));
  TsdfVolume behind(volume_of(0.64), {0.0, 0.0, -2.0});
  fuse({wall_view(2.0F)}, behind);
  EXPECT_EQ(behind.num_blocks(), 0U);
}

TEST(Integrator, WorksWithoutColorAndWithPartsOfImages) {
  View whole = wall_view(1.0F);
  View part = whole;
  part.frame.color_rgb.release();
  const cv::Mat_<float> wide(240, 400, 1.0F);
  part.frame.depth_m = wide(cv::Rect(30, 0, 320, 240));
  ASSERT_FALSE(part.frame.depth_m.isContinuous());
  TsdfVolume from_whole(volume_of(3.2));
  TsdfVolume from_part(volume_of(3.2));
  fuse({whole}, from_whole);
  fuse({part}, from_part);
  const DetachedBlocks a = from_whole.snapshot();
  const DetachedBlocks b = from_part.snapshot();
  ASSERT_EQ(a.coords, b.coords);
  for (std::size_t i = 0; i < a.coords.size(); ++i) {
    ASSERT_EQ(a.voxels[i]->voxels, b.voxels[i]->voxels);
    ASSERT_EQ(b.colors[i]->colors[0], 0U);
  }
}

TEST(Integrator, RefusesAFrameThatDoesNotFitAndLeavesTheVolume) {
  TsdfVolume volume(volume_of(3.2));
  const auto refusal = [&volume](auto spoil) {
    return [&volume, spoil] {
      View view = wall_view(1.0F);
      spoil(view);
      fuse({view}, volume);
    };
  };
  EXPECT_THAT(refusal([](View& v) { v.frame.depth_m = v.frame.depth_m.rowRange(0, 200).clone(); }),
              ThrowsMessage<std::invalid_argument>(HasSubstr("depth_m is 320x200")));
  EXPECT_THAT(refusal([](View& v) { v.frame.color_rgb = cv::Mat_<cv::Vec3b>(10, 20); }),
              ThrowsMessage<std::invalid_argument>(HasSubstr("color_rgb is 20x10")));
  EXPECT_THAT(refusal([](View& v) { v.frame.intrinsics.fx = 0.0; }),
              ThrowsMessage<std::invalid_argument>(HasSubstr("fx")));
  EXPECT_THAT(refusal([](View& v) { v.frame.intrinsics.distortion[4] = 0.1; }),
              ThrowsMessage<std::invalid_argument>(HasSubstr("distortion")));
  EXPECT_THAT(refusal([](View& v) { v.X_WC.translation().x() = kNan; }),
              ThrowsMessage<std::invalid_argument>(HasSubstr("X_WC")));
  EXPECT_EQ(volume.num_blocks(), 0U);
}

TEST(Integrator, RefusesAConfigurationThatCannotWork) {
  EXPECT_THAT([] { Integrator integrator({.min_depth_m = -0.1}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("min_depth_m is -0.1")));
  EXPECT_THAT([] { Integrator integrator({.min_depth_m = 2.0, .max_depth_m = 1.0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("max_depth_m is 1")));
}

}  // namespace
}  // namespace kintsugi::mapper

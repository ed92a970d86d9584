#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/core/kernels/instruction_set.hpp"
#include "mapper/core/kernels/kernels.hpp"
#include "mapper/core/volume/tsdf_block.hpp"
#include "tests/mapper/core/slow_integration.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kWidth = 41;  // odd: no row is aligned
constexpr int kHeight = 23;
constexpr int kNumPixels = kWidth * kHeight;

struct Images {
  std::vector<float> depth_m;
  std::vector<std::uint32_t> color_rgbx;
};

/// Depths around 1 m with every kind of bad pixel among them.
Images random_images(std::mt19937& random) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const float bad[] = {kNan, kInfinity, -kInfinity, 0.0F, -1.0F, 0.05F, 80.0F};
  std::uniform_real_distribution<float> depth(0.9F, 1.1F);
  Images images;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const auto draw = random();
    images.depth_m.push_back(draw % 8 == 0 ? bad[draw / 8 % std::size(bad)] : depth(random));
    images.color_rgbx.push_back(random());
  }
  return images;
}

IntegrationFrame make_frame(const Images& images, float angle_rad) {
  constexpr float kVoxel_m = 0.01F;
  IntegrationFrame frame;
  frame.depth_m = images.depth_m.data();
  frame.color_rgbx = images.color_rgbx.data();
  frame.camera = {
      .width = kWidth, .height = kHeight, .fx = 60.0F, .fy = 61.0F, .cx = 20.2F, .cy = 10.9F};
  const float c = std::cos(angle_rad) * kVoxel_m;
  const float s = std::sin(angle_rad) * kVoxel_m;
  const float steps[3][3] = {{c, 0, s}, {0, kVoxel_m, 0}, {-s, 0, c}};
  std::copy(&steps[0][0], &steps[0][0] + 9, &frame.step_C[0][0]);
  frame.min_depth_m = 0.1F;
  frame.max_depth_m = 5.0F;
  frame.truncation = {.max_m = 4 * kVoxel_m, .inverse_max = 0.25F / kVoxel_m, .variance = {}};
  frame.max_weight = 20.0F;
  frame.max_color_weight = 15.0F;
  return frame;
}

struct Block {
  VoxelBlock voxels{};
  ColorBlock colors{};

  IntegrationBlock at(float x, float y, float z) {
    return {.voxels = voxels.voxels.data(), .colors = colors.colors.data(), .origin_C = {x, y, z}};
  }
};

/// A voxel that stays in the middle of one pixel with this depth.
Voxel fuse_one(const std::vector<float>& depths_m, float z, Block& block) {
  Images images{std::vector<float>(kNumPixels), std::vector<std::uint32_t>(kNumPixels, 0x010A64C8)};
  IntegrationFrame frame = make_frame(images, 0.0F);
  for (const float depth_m : depths_m) {
    std::fill(images.depth_m.begin(), images.depth_m.end(), depth_m);
    kPortableKernels.integrate_block(frame, block.at(0.0F, 0.0F, z));
  }
  return block.voxels.voxels[0];
}

TEST(IntegrationKernel, StoresTheMeanOfTheTruncatedDistances) {
  Block block;
  // Truncation 40 mm; the third measurement is beyond it.
  const Voxel voxel = fuse_one({1.01F, 1.03F, 1.5F}, 1.0F, block);
  EXPECT_EQ(voxel_weight(voxel), 3);
  EXPECT_NEAR(voxel_distance(voxel), (0.25 + 0.75 + 1.0) / 3, 3.0 / kDistanceScale);
}

TEST(IntegrationKernel, LeavesWhatIsHiddenBehindTheSurface) {
  Block block;
  EXPECT_EQ(fuse_one({0.95F}, 1.0F, block), 0U);
  EXPECT_EQ(voxel_weight(fuse_one({0.97F}, 1.0F, block)), 1);
  EXPECT_NEAR(voxel_distance(block.voxels.voxels[0]), -0.75, 2.0 / kDistanceScale);
}

TEST(IntegrationKernel, CapsTheWeightAndThenForgets) {
  Block block;
  const Voxel voxel = fuse_one(std::vector<float>(25, 1.0F), 1.0F, block);
  EXPECT_EQ(voxel_weight(voxel), 20);
  EXPECT_EQ(block.colors.colors[0] >> 24, 15U);
  EXPECT_EQ(block.colors.colors[0] & 0xFFFFFFU, 0x0A64C8U);
  EXPECT_GT(voxel_distance(fuse_one(std::vector<float>(100, 1.04F), 1.0F, block)), 0.98);
}

TEST(IntegrationKernel, ColorsOnlyWithinTheTruncationDistance) {
  Block block;
  fuse_one({1.1F}, 1.0F, block);
  EXPECT_EQ(voxel_weight(block.voxels.voxels[0]), 1);
  EXPECT_EQ(block.colors.colors[0], 0U);
}

TEST(IntegrationKernel, KeepsColorsWhereAFrameHasNone) {
  std::mt19937 random(1);
  const Images images = random_images(random);
  IntegrationFrame frame = make_frame(images, 0.0F);
  frame.color_rgbx = nullptr;
  Block block;
  block.colors.colors.fill(0x01020304);
  kPortableKernels.integrate_block(frame, block.at(-0.04F, -0.04F, 0.96F));
  EXPECT_TRUE(std::all_of(block.colors.colors.begin(), block.colors.colors.end(),
                          [](VoxelColor color) { return color == 0x01020304; }));
}

TEST(IntegrationKernel, TruncatesAtMoreWhereDepthIsFarther) {
  Images images{std::vector<float>(kNumPixels), std::vector<std::uint32_t>(kNumPixels)};
  IntegrationFrame frame = make_frame(images, 0.0F);
  // 20 mm at depths below 1.06 m, 40 mm at 1.5 m, 160 mm beyond 3 m.
  constexpr float kGrowth = 0.25F / (1.5F * 1.5F);
  frame.truncation = {.max_m = 0.16F,
                      .inverse_max = 6.25F,
                      .min_share = 0.125F,
                      .sigmas_per_m = 1.0F,
                      .variance = {{0.0F, 0.0F, kGrowth * kGrowth}}};
  const auto fuse = [&](float depth_m, float z) {
    Block block;
    std::fill(images.depth_m.begin(), images.depth_m.end(), depth_m);
    kPortableKernels.integrate_block(frame, block.at(0.0F, 0.0F, z));
    return block.voxels.voxels[0];
  };
  constexpr float kTolerance = 3.0F / kDistanceScale;
  EXPECT_NEAR(voxel_distance(fuse(0.7F, 0.4F)), 0.125F, kTolerance);
  EXPECT_NEAR(voxel_distance(fuse(1.5F, 1.0F)), 0.25F, kTolerance);
  EXPECT_NEAR(voxel_distance(fuse(4.0F, 1.0F)), 1.0F, kTolerance);
  EXPECT_NEAR(voxel_distance(fuse(4.0F, 4.1F)), -0.1F / 0.16F, kTolerance);
  EXPECT_EQ(voxel_weight(fuse(1.5F, 1.541F)), 0);
  EXPECT_EQ(voxel_weight(fuse(1.5F, 1.539F)), 1);
}

/// The same random frames and blocks for every instruction set.
class IntegrationKernels : public ::testing::TestWithParam<InstructionSet> {};

TEST_P(IntegrationKernels, WriteTheBytesOfAVoxelAtATime) {
  if (!is_supported(GetParam())) GTEST_SKIP() << "not on this processor";
  const IntegrateBlock integrate_block = kernels_for(GetParam()).integrate_block;
  std::mt19937 random(42);
  // Inside the view, across its border, beside it, behind the camera and around the camera.
  std::uniform_real_distribution<float> lateral(-0.5F, 0.5F);
  std::uniform_real_distribution<float> any_depth(-0.2F, 1.3F);
  std::uniform_real_distribution<float> surface_depth(0.8F, 1.1F);
  int num_updated = 0;
  for (int round = 0; round < 400; ++round) {
    const Images images = random_images(random);
    IntegrationFrame frame = make_frame(images, 0.01F * static_cast<float>(round));
    if (round % 5 == 0) frame.color_rgbx = nullptr;
    if (round % 2 == 0) {
      frame.truncation.min_share = 0.25F;
      frame.truncation.sigmas_per_m = 2.0F;
      frame.truncation.variance = {{0.01F, 0.02F, 0.06F}};  // a share of 0.4 to 0.7
    }
    const float origin[3] = {lateral(random), lateral(random),
                             round % 2 == 0 ? any_depth(random) : surface_depth(random)};
    Block expected;
    for (Voxel& voxel : expected.voxels.voxels) {
      voxel = ((random() % 21) << 16) | (random() & 0xFFFFU);
    }
    for (VoxelColor& color : expected.colors.colors) color = random() & 0x0FFFFFFFU;
    const Block before = expected;
    Block actual = expected;
    for (int repeat = 0; repeat < 3; ++repeat) {
      testing::integrate_slowly(frame, expected.at(origin[0], origin[1], origin[2]));
      integrate_block(frame, actual.at(origin[0], origin[1], origin[2]));
    }
    ASSERT_EQ(actual.voxels.voxels, expected.voxels.voxels) << "round " << round;
    ASSERT_EQ(actual.colors.colors, expected.colors.colors) << "round " << round;
    num_updated += expected.voxels.voxels != before.voxels.voxels ? 1 : 0;
  }
  EXPECT_GT(num_updated, 50) << "the comparison compared nothing";
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, IntegrationKernels, ::testing::ValuesIn(kInstructionSets),
                         [](const auto& info) { return std::string(name_of(info.param)); });

}  // namespace
}  // namespace kintsugi::mapper

#include <future>
#include <stdexcept>

#include <gtest/gtest.h>

#include "mapper/core/slices/slice_worker.hpp"

namespace kintsugi::mapper {
namespace {

/// One block through which the plane z = 4 voxels passes, well observed; 64 points.
DetachedBlocks plane_blocks(SliceKind kind) {
  DetachedBlocks blocks;
  blocks.kind = kind;
  blocks.resolution_m = 0.01F;
  blocks.truncation_m = 0.04F;
  struct Storage {
    VoxelBlock voxels{};
    ColorBlock colors{};
  };
  auto storage = std::make_shared<Storage>();
  for (int z = 0; z < kBlockSide; ++z) {
    const float distance = (static_cast<float>(z) + 0.5F - 4.0F) / 4.0F;
    const auto raw = static_cast<std::int16_t>(distance * kDistanceScale);
    for (int i = 0; i < kBlockSide * kBlockSide; ++i) {
      storage->voxels.voxels[z * kBlockSide * kBlockSide + i] =
          (20U << 16U) | static_cast<std::uint16_t>(raw);
    }
  }
  blocks.coords.push_back(make_block_coord(0, 0, 0));
  blocks.voxels.push_back(&storage->voxels);
  blocks.colors.push_back(&storage->colors);
  blocks.storage = std::move(storage);
  return blocks;
}

TEST(SliceWorker, ExtractsWhatItIsGivenWithItsTimeAndPose) {
  SliceWorker worker({});
  Pose X_WC = Pose::Identity();
  X_WC.translation() << 1, 2, 3;
  worker.submit(plane_blocks(SliceKind::kShiftMinusY),
                {.utime = 12345, .X_WC = X_WC, .at = {.keyframe = 0, .place = {.part = 2}}});
  const std::vector<CloudSlice> slices = worker.drain();
  ASSERT_EQ(slices.size(), 1U);
  EXPECT_EQ(slices[0].id, 0);
  EXPECT_EQ(slices[0].utime, 12345);
  EXPECT_EQ(slices[0].kind, SliceKind::kShiftMinusY);
  EXPECT_FLOAT_EQ(slices[0].resolution_m, 0.01F);
  EXPECT_TRUE(slices[0].X_WC.isApprox(X_WC));
  ASSERT_EQ(slices[0].points_W.size(), 64U);
  EXPECT_NEAR(slices[0].points_W[0].z, 0.04F, 1e-5F);
  EXPECT_GT(worker.busy_ms(), 0.0);
}

TEST(SliceWorker, KeepsTheOrderWhenItIsOutrun) {
  SliceWorker::Config config;
  config.max_queued_blocks = 2;
  SliceWorker worker(config);
  std::vector<CloudSlice> slices;
  const auto collect = [&](std::vector<CloudSlice> more) {
    for (CloudSlice& slice : more) slices.push_back(std::move(slice));
  };
  for (int i = 0; i < 30; ++i) {
    worker.submit(plane_blocks(SliceKind::kShiftPlusX), {.utime = i, .X_WC = Pose::Identity()});
    collect(worker.take_finished());
  }
  collect(worker.drain());
  ASSERT_EQ(slices.size(), 30U);
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(slices[i].id, i);
    EXPECT_EQ(slices[i].utime, i);
  }
  EXPECT_TRUE(worker.drain().empty());
}

TEST(SliceWorker, KeepsTheOrderWhenBlocksAreStillWorkedOn) {
  SliceWorker worker({});
  std::promise<DetachedBlocks> blocks;
  worker.submit(blocks.get_future().share(), {.utime = 1, .X_WC = Pose::Identity()});
  worker.submit(plane_blocks(SliceKind::kFinal), {.utime = 2, .X_WC = Pose::Identity()});
  EXPECT_TRUE(worker.take_finished().empty());
  blocks.set_value(plane_blocks(SliceKind::kShiftPlusX));
  const std::vector<CloudSlice> slices = worker.drain();
  ASSERT_EQ(slices.size(), 2U);
  EXPECT_EQ(slices[0].utime, 1);
  EXPECT_EQ(slices[0].kind, SliceKind::kShiftPlusX);
  EXPECT_FLOAT_EQ(slices[0].resolution_m, 0.01F);
  EXPECT_EQ(slices[0].points_W.size(), 64U);
  EXPECT_EQ(slices[1].utime, 2);
}

TEST(SliceWorker, PassesOnWhyBlocksDoNotCome) {
  SliceWorker worker({});
  std::promise<DetachedBlocks> blocks;
  worker.submit(blocks.get_future().share(), {});
  blocks.set_exception(std::make_exception_ptr(std::runtime_error("no memory")));
  EXPECT_THROW(worker.drain(), std::runtime_error);
}

TEST(SliceWorker, CanBeLeftWithWorkQueued) {
  SliceWorker worker({});
  for (int i = 0; i < 5; ++i) {
    worker.submit(plane_blocks(SliceKind::kFinal), {.utime = i, .X_WC = Pose::Identity()});
  }
}

TEST(SliceWorker, RefusesAQueueOfNoLength) {
  SliceWorker::Config config;
  config.max_queued_blocks = 0;
  EXPECT_THROW(SliceWorker{config}, std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper

#include <algorithm>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/core/volume/tsdf_block_pool.hpp"

namespace kintsugi::mapper {
namespace {

BlockCoord at(int x) { return make_block_coord(x, 0, 0); }

TEST(TsdfBlockPool, RecyclesASlotWhenAllHaveGivenItBack) {
  TsdfBlockPool pool;
  const BlockSlot slot = pool.take(at(1));
  pool.voxels(slot).voxels[7] = 5;
  pool.hold(slot);
  pool.give_back(slot);
  EXPECT_NE(pool.take(at(2)), slot) << "still held";
  pool.give_back(slot);
  EXPECT_EQ(pool.take(at(3)), slot);
  EXPECT_EQ(pool.coord(slot), at(3));
  EXPECT_EQ(pool.voxels(slot).voxels[7], 0U);
  EXPECT_EQ(pool.end(), 2);
}

TEST(TsdfBlockPool, CopiesVoxels) {
  TsdfBlockPool pool;
  const BlockSlot slot = pool.take(at(4));
  pool.voxels(slot).voxels.fill(9);
  const BlockSlot copy = pool.take_copy_of_voxels(slot);
  pool.voxels(slot).voxels.fill(8);
  EXPECT_NE(copy, slot);
  EXPECT_EQ(pool.coord(copy), at(4));
  EXPECT_EQ(pool.voxels(copy).voxels[511], 9U);
}

TEST(TsdfBlockPool, KeepsWhatIsLentUntilTheLoanEndsOnAnyThread) {
  TsdfBlockPool pool;
  std::vector<BlockSlot> slots(10);
  for (int i = 0; i < 10; ++i) slots[i] = pool.take(at(i));
  std::shared_ptr<const void> loan = pool.lend(slots);
  EXPECT_EQ(pool.take(at(20)), 10) << "nothing is free";
  std::thread([&loan] { loan.reset(); }).join();
  std::vector<BlockSlot> again(10);
  for (int i = 0; i < 10; ++i) again[i] = pool.take(at(30 + i));
  std::sort(again.begin(), again.end());
  EXPECT_EQ(again, slots);
  EXPECT_EQ(pool.end(), 11);
}

TEST(TsdfBlockPool, LeavesTheMemoryOfLoansThatOutliveIt) {
  std::optional<TsdfBlockPool> pool(std::in_place);
  const BlockSlot slot = pool->take(at(0));
  const VoxelBlock* voxels = &pool->voxels(slot);
  pool->voxels(slot).voxels[3] = 77;
  const std::shared_ptr<const void> loan = pool->lend({slot});
  pool.reset();
  EXPECT_EQ(voxels->voxels[3], 77U);
}

/// Where the camera goes over to other surface, all blocks are lent and as many take their place.
TEST(TsdfBlockPool, GivesBackTheMemoryOfPagesWithoutABlock) {
  constexpr std::size_t kPerPage = 1024;
  TsdfBlockPool pool;
  std::vector<BlockSlot> old(3 * kPerPage);
  for (BlockSlot& slot : old) slot = pool.take(at(1));
  const std::size_t bytes_of_old = pool.memory_bytes();
  std::shared_ptr<const void> loan = pool.lend(old);
  std::vector<BlockSlot> later(2 * kPerPage);
  for (BlockSlot& slot : later) slot = pool.take(at(2));
  pool.voxels(later.back()).voxels[3] = 77;
  pool.tidy();
  EXPECT_GT(pool.memory_bytes(), 1.6 * bytes_of_old) << "what is lent stays";
  loan.reset();
  pool.tidy();
  EXPECT_LT(pool.memory_bytes(), 0.7 * bytes_of_old);
  EXPECT_EQ(pool.voxels(later.back()).voxels[3], 77U);
  const BlockSlot again = pool.take(at(3));
  EXPECT_EQ(again, 0) << "the lowest one";
  EXPECT_GT(pool.memory_bytes(), 0.95 * bytes_of_old) << "and with it its page";
  pool.voxels(again).voxels[5] = 9;
  pool.tidy();
  EXPECT_EQ(pool.voxels(again).voxels[5], 9U) << "its page is in use";
}

TEST(TsdfBlockPool, KeepsBlocksOneAfterTheOther) {
  TsdfBlockPool pool;
  for (int i = 0; i < 3000; ++i) {
    const BlockSlot slot = pool.take(make_block_coord(i, 0, 0));
    ASSERT_EQ(&pool.voxels(slot), &pool.voxels(0) + slot);
    pool.voxels(slot).voxels[0] = static_cast<Voxel>(i);
  }
  for (BlockSlot slot = 0; slot < pool.end(); ++slot) {
    ASSERT_EQ(pool.voxels(slot).voxels[0], static_cast<Voxel>(slot));
  }
  pool.give_back(1234);
  EXPECT_EQ(pool.take({}), 1234);
  EXPECT_EQ(pool.voxels(1234).voxels[0], 0U) << "a recycled block is empty";
}

}  // namespace
}  // namespace kintsugi::mapper

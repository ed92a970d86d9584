#include <memory>
#include <random>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/reactivation/tile_store.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Of all values of all bits.
StoredBlock random_block(const BlockCoord& coord, unsigned seed) {
  std::mt19937 random(seed);
  StoredBlock block{coord, {}, {}};
  for (Voxel& voxel : block.voxels.voxels) voxel = random();
  for (VoxelColor& color : block.colors.colors) color = random();
  return block;
}

bool same(const StoredBlock& a, const StoredBlock& b) {
  return a.coord == b.coord && a.voxels.voxels == b.voxels.voxels &&
         a.colors.colors == b.colors.colors;
}

TEST(BlockPacking, GivesTheSameBlockBack) {
  const StoredBlock block = random_block(make_block_coord(1, -2, 3), 5);
  StoredBlock back{block.coord, {}, {}};
  unpack(pack(block.coord, block.voxels, block.colors), back.voxels, back.colors);
  EXPECT_TRUE(same(back, block));
}

TEST(BlockPacking, TakesLittleForABlockThatIsAlike) {
  StoredBlock block{{}, {}, {}};
  block.voxels.voxels.fill(0x00051234);
  EXPECT_LT(pack(block.coord, block.voxels, block.colors).bytes.size(), 100U);
}

TEST(BlockPacking, RefusesOtherBytes) {
  StoredBlock out;
  EXPECT_THROW(unpack({{}, {}}, out.voxels, out.colors), std::logic_error);
  EXPECT_THROW(unpack({{}, std::vector<char>(4096, 'x')}, out.voxels, out.colors),
               std::logic_error);
}

/// Tiles of two blocks a side.
class Store : public ::testing::Test {
 protected:
  void keep(const std::vector<StoredBlock>& blocks) {
    auto storage = std::make_shared<std::vector<StoredBlock>>(blocks);
    DetachedBlocks left;
    for (const StoredBlock& block : *storage) {
      left.coords.push_back(block.coord);
      left.voxels.push_back(&block.voxels);
      left.colors.push_back(&block.colors);
    }
    left.storage = storage;
    store_.keep(left);
  }
  std::vector<TileVisit> visits() const {
    std::vector<TileVisit> found;
    store_.for_each([&](const TileVisit& visit, int /*keyframe*/) { found.push_back(visit); });
    return found;
  }

  const TileCoord tile_{.z = 0, .y = 0, .x = 0};
  const TileCoord next_{.z = 0, .y = 0, .x = 1};
  const StoredBlock first_ = random_block(make_block_coord(0, 0, 0), 1);
  const StoredBlock second_ = random_block(make_block_coord(1, 1, 0), 2);
  const StoredBlock other_ = random_block(make_block_coord(2, 0, 0), 3);
  TileStore store_{TileGrid(0.16, 0.01), 1.0};
};

TEST_F(Store, KeepsBlocksByTileUntilTheyAreForgotten) {
  keep({first_, other_});
  keep({second_});
  EXPECT_THAT(visits(), ElementsAre(TileVisit{tile_}, TileVisit{next_}));
  for (int i = 0; i < 3; ++i) {
    const auto blocks = store_.blocks_of({tile_});
    ASSERT_EQ(blocks.size(), 2U);
    EXPECT_TRUE(same(blocks[0].copy(), first_));
    EXPECT_TRUE(same(blocks[1].copy(), second_)) << "packed or not";
    store_.tidy();
    store_.tidy();
  }
  EXPECT_GT(store_.bytes(), 0U);
  store_.forget({tile_});
  EXPECT_THAT(store_.blocks_of({tile_}), IsEmpty());
  EXPECT_THAT(visits(), ElementsAre(TileVisit{next_}));
}

TEST_F(Store, KeepsTheNewerOfABlockThatLeftTwice) {
  keep({first_});
  const StoredBlock newer = random_block(first_.coord, 9);
  keep({newer});
  ASSERT_EQ(store_.blocks_of({tile_}).size(), 1U);
  EXPECT_TRUE(same(store_.blocks_of({tile_}).front().copy(), newer));
}

TEST_F(Store, NumbersClosedVisitsAlsoThoseWithoutBlocks) {
  store_.close(tile_, 3);
  keep({first_});
  store_.close(tile_, 4);
  keep({second_});
  EXPECT_THAT(visits(), ElementsAre(TileVisit{tile_}, (TileVisit{tile_, 1})));
  store_.for_each([&](const TileVisit& visit, int keyframe) {
    EXPECT_EQ(keyframe, visit.number == 1 ? 4 : -1);
  });
  EXPECT_TRUE(same(store_.blocks_of({tile_, 1}).front().copy(), first_));
  EXPECT_TRUE(same(store_.blocks_of({tile_}).front().copy(), second_));
}

TEST_F(Store, ForgetsWhatWasClosedLongestAgo) {
  std::vector<StoredBlock> blocks;
  for (int x = 0; x < 600; ++x) blocks.push_back(random_block(make_block_coord(x, 0, 0), x));
  keep(blocks);  // which cannot be packed: 2.5 MB
  for (int x = 299; x >= 0; --x) store_.close({.z = 0, .y = 0, .x = x}, 0);
  EXPECT_GT(store_.bytes(), 2'400'000U);
  store_.tidy();
  EXPECT_LE(store_.bytes(), 1'000'000U);
  EXPECT_GT(store_.bytes(), 900'000U);
  for (const TileVisit& visit : visits()) EXPECT_LT(visit.tile.x, 130);
  for (const TileVisit& visit : visits()) store_.forget(visit);
  EXPECT_EQ(store_.bytes(), 0U);
}

TEST_F(Store, CountsNoVisitThatHasComeBack) {
  for (int round = 0; round < 5; ++round) {
    keep({first_});
    store_.close(tile_, 0);
    EXPECT_EQ(store_.num_closed(), 1U);
    store_.forget({tile_, round});
    EXPECT_EQ(store_.num_closed(), 0U);
  }
}

TEST_F(Store, FindsABlockInTheVisitsThatAreAllowed) {
  keep({first_});
  store_.close(tile_, 0);
  const StoredBlock again = random_block(first_.coord, 7);
  keep({again});
  store_.close(tile_, 1);
  const auto of = [](int keyframe) {
    return [keyframe](const TileVisit& /*visit*/, int seen_at) { return seen_at == keyframe; };
  };
  const auto any = [](const TileVisit& /*visit*/, int /*keyframe*/) { return true; };
  ASSERT_NE(store_.find(first_.coord, any), nullptr);
  EXPECT_TRUE(same(store_.find(first_.coord, of(0))->copy(), first_));
  EXPECT_TRUE(same(store_.find(first_.coord, any)->copy(), again)) << "the last one";
  EXPECT_EQ(store_.find(first_.coord, of(2)), nullptr);
  EXPECT_EQ(store_.find(second_.coord, any), nullptr);
}

}  // namespace
}  // namespace kintsugi::mapper

#include <cstddef>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/reactivation/covered_voxels.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::IsEmpty;

enum class There { kNotKnown, kCovered, kDiffers };

/// A floor of 3 x 3 blocks, two voxels thick, x and y from 0 to 23.
class FloorOfVoxels : public ::testing::Test {
 protected:
  using Places = std::vector<std::pair<int, int>>;

  /// Where not just the voxels of `expected(x, y)` are covered after the other map has
  /// `there(x, y)`.
  template <typename Function, typename Expected>
  static Places differences(Function there, Expected expected) {
    std::vector<BlockCoord> coords;
    std::vector<CoveredVoxels> blocks;
    for (const int block : {4, 0, 8, 1, 7, 2, 6, 3, 5}) {
      coords.push_back(make_block_coord(block % 3, block / 3, -1));
      CoveredVoxels& voxels = blocks.emplace_back();
      for_each_voxel(coords.back(), [&](int x, int y, int index) {
        voxels.surface.set(index);
        voxels.covered[index] = there(x, y) == There::kCovered;
        voxels.differing[index] = there(x, y) == There::kDiffers;
      });
    }
    const std::vector<CoveredVoxels> result = closed(coords, blocks);
    Places places;
    for (std::size_t i = 0; i < coords.size(); ++i) {
      EXPECT_EQ(result[i].surface, blocks[i].surface);
      EXPECT_EQ(result[i].differing, blocks[i].differing);
      EXPECT_TRUE((result[i].covered & ~result[i].surface).none());
      for_each_voxel(coords[i], [&](int x, int y, int index) {
        if (result[i].covered[index] != expected(x, y)) places.emplace_back(x, y);
      });
    }
    return places;
  }
  /// The same for a map that covers `covered(x, y)`, and nothing is known of the rest.
  template <typename Covered, typename Expected>
  static Places differences_if_covered(Covered covered, Expected expected) {
    return differences(
        [&](int x, int y) { return covered(x, y) ? There::kCovered : There::kNotKnown; }, expected);
  }

 private:
  template <typename Visit>
  static void for_each_voxel(const BlockCoord& block, Visit visit) {
    for (int z = 3; z <= 4; ++z) {
      for (int y = 0; y < kBlockSide; ++y) {
        for (int x = 0; x < kBlockSide; ++x) {
          visit(kBlockSide * block.x + x, kBlockSide * block.y + y, voxel_index(x, y, z));
        }
      }
    }
  }
};

bool always(int /*x*/, int /*y*/) { return true; }
bool never(int /*x*/, int /*y*/) { return false; }

TEST_F(FloorOfVoxels, StaysAsItIsIfAllOrNoneIsCovered) {
  EXPECT_THAT(differences_if_covered(always, always), IsEmpty());
  EXPECT_THAT(differences_if_covered(never, never), IsEmpty());
}

TEST_F(FloorOfVoxels, KeepsAStraightBorderInABlockAndBetweenTwo) {
  for (const int border : {7, 8, 9, 11}) {
    const auto before = [&](int x, int /*y*/) { return x < border; };
    EXPECT_THAT(differences_if_covered(before, before), IsEmpty()) << border;
    const auto beyond = [&](int /*x*/, int y) { return y > border; };
    EXPECT_THAT(differences_if_covered(beyond, beyond), IsEmpty()) << border;
  }
}

TEST_F(FloorOfVoxels, IsCoveredWhereMoreThanAThirdIs) {
  const auto two_fifths = [](int x, int y) { return (x + 2 * y) % 5 < 2; };
  EXPECT_THAT(differences_if_covered(two_fifths, always), IsEmpty());
}

TEST_F(FloorOfVoxels, IsNotCoveredBySpecks) {
  const auto specks = [](int x, int y) { return x % 7 < 2 && y % 7 < 2; };
  EXPECT_THAT(differences_if_covered(specks, never), IsEmpty());
}

TEST_F(FloorOfVoxels, KeepsTheSmallestThingThatTheOtherMapDoesNotHave) {
  const auto is_thing = [](int x, int y) { return (x == 8 && y == 5) || (x == 12 && y > 12); };
  EXPECT_THAT(
      differences([&](int x, int y) { return is_thing(x, y) ? There::kDiffers : There::kCovered; },
                  [&](int x, int y) { return !is_thing(x, y); }),
      IsEmpty());
}

}  // namespace
}  // namespace kintsugi::mapper

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/slices/patch_maker.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr TileCoord kHere{.z = 0, .y = 0, .x = 0};
constexpr TileCoord kThere{.z = 0, .y = 0, .x = 1};

/// Tiles of one block. Each block (x, 0, 0) has a point for each of `weights`.
struct Patches : ::testing::Test {
  static ExtractedSurface surface(const std::vector<std::pair<int, std::vector<float>>>& blocks) {
    ExtractedSurface surface;
    for (const auto& [x, weights] : blocks) {
      surface.blocks.push_back(
          {make_block_coord(x, 0, 0), surface.points_W.size(), weights.size()});
      for (const float weight : weights) surface.points_W.emplace_back().weight = weight;
    }
    return surface;
  }
  static std::vector<float> weights(const CloudSlice& slice) {
    std::vector<float> weights;
    for (const CloudPoint& point : slice.points_W) weights.push_back(point.weight);
    return weights;
  }
  static CloudSlice header() {
    CloudSlice header;
    header.utime = 77;
    header.resolution_m = 0.01F;
    return header;
  }

  PatchMaker maker{TileGrid(0.08, 0.01)};
};

TEST_F(Patches, AreNumberedInTheOrderInWhichTheyGetPoints) {
  const auto first = maker.make({{{kHere}, {kThere}}}, surface({{1, {5}}}), header());
  ASSERT_EQ(first.size(), 1U) << "a patch that never had points is left out";
  EXPECT_EQ(first[0].id, 0);
  EXPECT_EQ(first[0].revision, 0);
  EXPECT_EQ(first[0].kind, SliceKind::kPatch);
  EXPECT_EQ(first[0].utime, 77);
  EXPECT_TRUE(first[0].in_volume);
  EXPECT_TRUE(first[0].ends_batch);

  const auto second = maker.make({{{kHere}, {kThere}}}, surface({{0, {6, 7}}}), header());
  ASSERT_EQ(second.size(), 2U);
  EXPECT_EQ(second[0].id, 1);
  EXPECT_FALSE(second[0].ends_batch);
  EXPECT_EQ(second[1].id, 0) << "its surface went: a revision without points";
  EXPECT_EQ(second[1].revision, 1);
  EXPECT_THAT(second[1].points_W, IsEmpty());
  EXPECT_TRUE(second[1].ends_batch);
}

TEST_F(Patches, HaveWhatLeftAndThenWhatIsInTheVolume) {
  maker.make({{{kHere}}}, surface({{0, {1, 2}}}), header());
  maker.keep(surface({{0, {3}}, {1, {4}}}));
  const auto slices = maker.make({{{kHere}}}, surface({{0, {5}}}), header());
  ASSERT_EQ(slices.size(), 1U);
  EXPECT_THAT(weights(slices[0]), ElementsAre(3, 5));
}

TEST_F(Patches, ThatHaveLeftForGoodAreOtherPatchesWhenTheVolumeComesBack) {
  maker.make({{{kHere}}}, surface({{0, {1}}}), header());
  maker.keep(surface({{0, {2}}}));
  const auto slices = maker.make({{{kHere, false}, {kHere, true}}}, surface({{0, {3}}}), header());
  ASSERT_EQ(slices.size(), 2U);
  EXPECT_FALSE(slices[0].in_volume);
  EXPECT_EQ(slices[0].id, 0);
  EXPECT_THAT(weights(slices[0]), ElementsAre(2));
  EXPECT_EQ(slices[1].id, 1);
  EXPECT_EQ(slices[1].revision, 0);
  EXPECT_THAT(weights(slices[1]), ElementsAre(3));
}

TEST_F(Patches, EndWithTheirLastRevisionsAndTheirSum) {
  maker.make({{{kHere}}}, surface({{0, {1}}}), header());
  maker.make({{{kHere}, {kThere}}}, surface({{0, {1}}, {1, {2}}}), header());
  maker.keep(surface({{0, {8}}, {1, {9}}, {5, {10}}}));
  const auto slices = maker.finish(header());
  ASSERT_EQ(slices.size(), 4U);
  EXPECT_THAT(weights(slices[0]), ElementsAre(8));
  EXPECT_EQ(slices[0].revision, 2);
  EXPECT_THAT(weights(slices[1]), ElementsAre(9));
  EXPECT_EQ(slices[1].revision, 1);
  EXPECT_THAT(weights(slices[2]), ElementsAre(10)) << "never sent before";
  EXPECT_TRUE(slices[2].ends_batch);
  EXPECT_FALSE(slices[2].in_volume);
  EXPECT_EQ(slices[3].kind, SliceKind::kFinal);
  EXPECT_EQ(slices[3].id, 3);
  EXPECT_THAT(slices[3].points_W, IsEmpty());
  EXPECT_EQ(slices[3].revision_sum, 3);
}

}  // namespace
}  // namespace kintsugi::mapper

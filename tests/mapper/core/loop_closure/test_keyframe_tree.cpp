#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/loop_closure/keyframe_tree.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::ElementsAre;

TEST(KeyframeTree, CountsTheWayInBothDirectionsAndOverForks) {
  KeyframeTree tree;
  tree.add(std::nullopt, 0.0);
  tree.add(0, 1.0);
  tree.add(1, 1.0);
  tree.add(2, 1.0);
  tree.add(0, 0.5);  // back at the first, then elsewhere
  EXPECT_EQ(tree.from(0), 0);
  EXPECT_EQ(tree.from(4), 0);
  EXPECT_THAT(tree.within(0, 1.5), ElementsAre(true, true, false, false, true));
  EXPECT_THAT(tree.within(3, 2.0), ElementsAre(false, true, true, true, false));
  EXPECT_THAT(tree.within(4, 1.5), ElementsAre(true, true, false, false, true));
  EXPECT_THAT(tree.within(4, 0.0), ElementsAre(false, false, false, false, true));
}

TEST(KeyframeTree, TellsTheWayBetweenTwoKeyframes) {
  KeyframeTree tree;
  tree.add(std::nullopt, 0.0);
  tree.add(0, 1.0);
  tree.add(1, 2.0);
  tree.add(1, 4.0);
  tree.add(3, 8.0);
  tree.add(std::nullopt, 0.0);
  tree.add(5, 1.0);
  EXPECT_EQ(tree.way_m(3, 3), 0.0);
  EXPECT_EQ(tree.way_m(0, 4), 13.0);
  EXPECT_EQ(tree.way_m(4, 0), 13.0);
  EXPECT_EQ(tree.way_m(2, 4), 14.0) << "by way of 1";
  EXPECT_EQ(tree.way_m(5, 6), 1.0);
  EXPECT_EQ(tree.way_m(6, 2), std::numeric_limits<double>::infinity()) << "another tree";
}

TEST(KeyframeTree, IsEmptyAtFirst) { EXPECT_TRUE(KeyframeTree().within(0, 10.0).empty()); }

}  // namespace
}  // namespace kintsugi::mapper

#include <limits>
#include <utility>
#include <vector>

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

TEST(KeyframeTree, GoesToOtherTreesOverJoins) {
  constexpr double kNoWay = std::numeric_limits<double>::infinity();
  KeyframeTree tree;
  for (int root = 0; root < 4; ++root) {  // each 8 keyframes in a row, the last tree joined to none
    for (int i = 0; i < 8; ++i)
      tree.add(i == 0 ? std::nullopt : std::optional(8 * root + i - 1), 1);
  }
  using Joins = std::vector<std::pair<int, int>>;
  EXPECT_EQ(tree.way_m(2, 12, Joins{}), kNoWay);
  EXPECT_EQ(tree.way_m(2, 12, Joins{{15, 0}}), 2.0 + 3.0) << "in either direction";
  EXPECT_EQ(tree.way_m(2, 12, Joins{{15, 0}, {3, 11}, {2, 9}}), 2.0) << "the shortest";
  EXPECT_EQ(tree.way_m(1, 22, Joins{{2, 10}, {12, 20}, {7, 23}}), 1.0 + 2.0 + 2.0)
      << "over a third tree";
  EXPECT_EQ(tree.way_m(22, 1, Joins{{2, 10}, {12, 20}, {7, 23}}), 5.0);
  EXPECT_EQ(tree.way_m(0, 7, Joins{{0, 8}, {8, 7}}), 7.0) << "of one tree, that of the tree";
  EXPECT_EQ(tree.way_m(2, 30, Joins{{15, 0}, {3, 18}}), kNoWay);

  const Joins joins = {{2, 10}, {12, 20}, {7, 23}, {0, 8}, {8, 7}};
  const std::vector<double> ways_m = tree.ways_m(1, joins);
  for (int i = 0; i < tree.size(); ++i) EXPECT_EQ(ways_m[i], tree.way_m(1, i, joins)) << i;
}

TEST(KeyframeTree, IsEmptyAtFirst) { EXPECT_TRUE(KeyframeTree().within(0, 10.0).empty()); }

}  // namespace
}  // namespace kintsugi::mapper

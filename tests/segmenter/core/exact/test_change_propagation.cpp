// Weights are in microunits: T is 1000, k is 500, theta of n points last joined at w is w + 500 /
// n.

#include <algorithm>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>

#include "tests/fuzz/random.hpp"
#include "tests/fuzz/random_cloud.hpp"
#include "tests/fuzz/weighted_lattice.hpp"
#include "tests/segmenter/core/exact/engine_parts.hpp"

namespace kintsugi::segmenter::exact {
namespace {

using Points = std::vector<PointIndex>;
using testing::EngineParts;

/// Points 0, 1, 2, ... in a row, by the weights of the edges from each to the next.
EngineParts row(std::vector<double> weights) {
  for (double& weight : weights) weight *= 1e-6;
  return EngineParts(fuzz::chain_of_weights(weights));
}

bool are_one(EngineParts& parts, PointIndex x, PointIndex y) {
  return parts.state().forest.root(x) == parts.state().forest.root(y);
}

TEST(ChangePropagation, ANewEdgeBetweenTwoFrozenComponentsIsWatched) {
  // {0, 1} freezes at 850, {2, 3} at 860.
  auto parts = row({600, 900, 610});
  parts.update({0, 1}, {});
  parts.update({2, 3}, {});
  EXPECT_EQ(parts.propagation().num_joins(), 1);
  EXPECT_FALSE(are_one(parts, 1, 2));
  EXPECT_EQ(parts.state().watches.size(), 1U);
  parts.expect_invariants();
}

TEST(ChangePropagation, ANewEdgeJoinsComponentsThatAreAlive) {
  auto parts = row({600, 840, 610});
  parts.update({0, 1}, {});
  parts.update({2, 3}, {});
  EXPECT_EQ(parts.propagation().num_joins(), 2);
  EXPECT_TRUE(are_one(parts, 0, 3));
  EXPECT_EQ(parts.state().watches.size(), 0U);
  parts.expect_invariants();
}

TEST(ChangePropagation, AWatchedEdgeIsTakenUpWhenTheBlockerFreezesLater) {
  // {0, 1, 2} freezes at 777, {1, 2} at 860.
  auto parts = row({600, 610, 800});
  parts.update({0, 1, 2, 3}, {});
  EXPECT_FALSE(are_one(parts, 2, 3));
  parts.expect_invariants();
  parts.update({}, {0});
  EXPECT_TRUE(are_one(parts, 2, 3));
  EXPECT_EQ(parts.state().watches.size(), 0U);
  parts.expect_invariants();
}

TEST(ChangePropagation, AHostThatFreezesSoonerLosesItsLaterGuests) {
  // As before, the other way round.
  auto parts = row({600, 610, 800});
  parts.update({1, 2, 3}, {});
  EXPECT_TRUE(are_one(parts, 2, 3));
  parts.update({0}, {});
  EXPECT_TRUE(are_one(parts, 0, 2));
  EXPECT_FALSE(are_one(parts, 2, 3));
  EXPECT_EQ(parts.state().watches.size(), 1U);
  parts.expect_invariants();
}

TEST(ChangePropagation, AGuestGivesUpItsFuture) {
  // 4 and 5 join each other at 140; once 3 is there, 4 has joined the others at 130.
  auto parts = row({100, 110, 120, 130, 140});
  parts.update({0, 1, 2, 4, 5}, {});
  const Vertices& vertices = parts.state().vertices;
  ASSERT_TRUE(vertices.host(5) == 4 || vertices.host(4) == 5);
  parts.update({3}, {});
  const PointIndex root = parts.state().forest.root(0);
  EXPECT_LE(root, 2U);
  EXPECT_EQ(vertices.host(4), root);
  EXPECT_EQ(vertices.host(5), root);
  EXPECT_EQ(parts.state().forest.key(5).b, 5U);
  parts.expect_invariants();
}

TEST(ChangePropagation, AHostThatLeavesIsFollowedByAGuest) {
  auto parts = row({100, 110, 120, 130});
  parts.update({0, 1, 2, 3, 4}, {});
  for (const PointIndex x : {0U, 4U, 1U, 3U}) {
    parts.update({}, {x});
    parts.expect_invariants();
  }
  EXPECT_EQ(parts.state().forest.root(2), 2U);
  EXPECT_EQ(parts.state().forest.history().final_theta(2), EngineParts::kRule.threshold);
}

/// Four points in a square: edges 0 - 1 of 10, 1 - 2 and 0 - 3 of about 40, 2 - 3 of 70.
EngineParts square() {
  fuzz::WeightedLattice lattice;
  lattice.add({1, 0}, 0, 10e-6);
  lattice.add({1, 1}, 1, 40e-6);
  lattice.add({0, 1}, 2, 70e-6);
  return EngineParts(lattice.points());
}

TEST(ChangePropagation, AnEdgeThatWasInsideIsFoundAgainWhenTheTreeFallsApart) {
  auto parts = square();
  parts.update({0, 1, 2, 3}, {});
  EXPECT_EQ(parts.propagation().num_explored(), 0);
  parts.update({}, {0});
  EXPECT_TRUE(are_one(parts, 2, 3));
  EXPECT_EQ(parts.propagation().num_explored(), 1);
  parts.expect_invariants();
}

TEST(ChangePropagation, APointOutsideTheTreeChangesNothingButSizes) {
  auto parts = square();
  parts.update({0, 1, 2, 3}, {});
  parts.update({}, {3});
  EXPECT_EQ(parts.propagation().num_explored(), 0);
  EXPECT_EQ(parts.propagation().num_joins(), 0);
  parts.expect_invariants();
}

TEST(ChangePropagation, AnEmptyChangeDoesNothing) {
  auto parts = square();
  parts.update({0, 1, 2, 3}, {});
  parts.update({}, {});
  EXPECT_EQ(parts.propagation().num_events(), 0);
  EXPECT_TRUE(parts.names().changed().empty());
  parts.expect_invariants();
}

TEST(ChangePropagation, GivesUpWhereMoreIsToBeExploredThanAllowed) {
  auto parts = square();
  parts.update({0, 1, 2, 3}, {});
  EXPECT_FALSE(parts.update({}, {0}, 0));
  parts.rebuild({}, {0});
  parts.expect_invariants();
  EXPECT_TRUE(parts.update({0}, {}, 0));
  parts.expect_invariants();
}

TEST(ChangePropagation, CostsWhatTheSmallerSideHas) {
  // A point near the end of a long row leaves: the few at the end are looked at, not the many.
  fuzz::WeightedLattice lattice;
  const std::vector<double> weights(400, 0.0);
  lattice.add_row(0, {1, 0}, weights);
  EngineParts parts(lattice.points());
  Points all(lattice.size());
  std::iota(all.begin(), all.end(), 0);
  parts.update(all, {});
  ASSERT_TRUE(are_one(parts, 0, 400));
  parts.update({}, {396});
  EXPECT_FALSE(are_one(parts, 0, 400));
  EXPECT_LE(parts.propagation().num_explored(), 4);
  EXPECT_LE(parts.names().changed().size(), 4U);
}

TEST(ChangePropagation, AFrozenComponentBlocksAllItsWatchesAtOnce) {
  // A row that freezes at about 150, and beside it points it cannot join. When it grows, one look
  // at its first watch tells as much.
  fuzz::WeightedLattice lattice;
  const std::vector<double> weights(20, 100e-6);
  lattice.add_row(0, {1, 0}, weights);
  for (PointIndex x = 0; x <= 20; x += 2) lattice.add({static_cast<int>(x), 1}, x, 900e-6);
  const PointIndex newcomer = lattice.add({-1, 0}, 0, 100e-6);
  EngineParts parts(lattice.points());
  Points others(newcomer);
  std::iota(others.begin(), others.end(), 0);
  parts.update(others, {});
  EXPECT_EQ(parts.state().watches.size(), 11U);
  parts.update({newcomer}, {});
  EXPECT_TRUE(are_one(parts, newcomer, 20));
  EXPECT_LE(parts.propagation().num_events(), 3);
  EXPECT_EQ(parts.state().watches.size(), 11U);
  parts.expect_invariants();
}

/// Points come, go, do both at once, and the state is built anew at times.
class ChangePropagationRuns : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  /// Each point of the wanted kind with the probability `share`.
  Points draw(const EngineParts& parts, PointIndex size, bool is_in, double share) {
    Points drawn;
    for (PointIndex x = 0; x < size; ++x) {
      if (parts.is_in(x) == is_in && random_.chance(share)) drawn.push_back(x);
    }
    return drawn;
  }

  fuzz::Random random_{GetParam()};
};

TEST_P(ChangePropagationRuns, KeepsTheInvariants) {
  for (int n = 0; n < 12; ++n) {
    const std::vector<CloudPoint> pool_W = fuzz::random_cloud(random_, random_.between(5, 70), {});
    const auto size = static_cast<PointIndex>(pool_W.size());
    EngineParts parts(pool_W);
    for (int step = 0; step < 25; ++step) {
      const double coming = random_.chance(0.7) ? random_.log_uniform(0.01, 0.6) : 0.0;
      const double going = random_.chance(0.6) ? random_.log_uniform(0.01, 0.3) : 0.0;
      const Points added = draw(parts, size, false, coming);
      const Points removed = draw(parts, size, true, going);
      const std::int64_t max_explored = random_.chance(0.2) ? 3 : INT64_MAX;
      if (!parts.update(added, removed, max_explored)) parts.rebuild(added, removed);
      parts.expect_invariants();
      ASSERT_FALSE(HasFailure()) << "cloud " << n << ", step " << step;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ChangePropagationRuns, ::testing::Range<std::uint64_t>(0, 10));

}  // namespace
}  // namespace kintsugi::segmenter::exact

// Weights are in microunits: T is 1000, k is 500, theta of n points last joined at w is w + 500 /
// n.

#include <algorithm>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>

#include "tests/fuzz/random.hpp"
#include "tests/fuzz/random_cloud.hpp"
#include "tests/fuzz/weighted_lattice.hpp"
#include "tests/segmenter/core/exact/exact_session.hpp"

namespace kintsugi::segmenter::exact {
namespace {

using Points = std::vector<PointIndex>;
using testing::Session;

/// Points 0, 1, 2, ... in a row, by the weights of the edges from each to the next.
Session row(std::vector<double> weights) {
  for (double& weight : weights) weight *= 1e-6;
  return Session(fuzz::chain_of_weights(weights));
}

bool are_one(Session& session, PointIndex x, PointIndex y) {
  return session.state().forest.root(x) == session.state().forest.root(y);
}

TEST(Replay, ANewEdgeBetweenTwoFrozenComponentsIsWatched) {
  // {0, 1} freezes at 850, {2, 3} at 860.
  auto session = row({600, 900, 610});
  session.update({0, 1}, {});
  session.update({2, 3}, {});
  EXPECT_EQ(session.replay().num_joins(), 1);
  EXPECT_FALSE(are_one(session, 1, 2));
  EXPECT_EQ(session.state().watches.size(), 1U);
  session.expect_invariants();
}

TEST(Replay, ANewEdgeJoinsComponentsThatAreAlive) {
  auto session = row({600, 840, 610});
  session.update({0, 1}, {});
  session.update({2, 3}, {});
  EXPECT_EQ(session.replay().num_joins(), 2);
  EXPECT_TRUE(are_one(session, 0, 3));
  EXPECT_EQ(session.state().watches.size(), 0U);
  session.expect_invariants();
}

TEST(Replay, AWatchedEdgeIsTakenUpWhenTheBlockerFreezesLater) {
  // {0, 1, 2} freezes at 777, {1, 2} at 860.
  auto session = row({600, 610, 800});
  session.update({0, 1, 2, 3}, {});
  EXPECT_FALSE(are_one(session, 2, 3));
  session.expect_invariants();
  session.update({}, {0});
  EXPECT_TRUE(are_one(session, 2, 3));
  EXPECT_EQ(session.state().watches.size(), 0U);
  session.expect_invariants();
}

TEST(Replay, AHostThatFreezesSoonerLosesItsLaterGuests) {
  // As before, the other way round.
  auto session = row({600, 610, 800});
  session.update({1, 2, 3}, {});
  EXPECT_TRUE(are_one(session, 2, 3));
  session.update({0}, {});
  EXPECT_TRUE(are_one(session, 0, 2));
  EXPECT_FALSE(are_one(session, 2, 3));
  EXPECT_EQ(session.state().watches.size(), 1U);
  session.expect_invariants();
}

TEST(Replay, AGuestGivesUpItsFuture) {
  // 4 and 5 join each other at 140; once 3 is there, 4 has joined the others at 130.
  auto session = row({100, 110, 120, 130, 140});
  session.update({0, 1, 2, 4, 5}, {});
  const Vertices& vertices = session.state().vertices;
  ASSERT_TRUE(vertices.host(5) == 4 || vertices.host(4) == 5);
  session.update({3}, {});
  const PointIndex root = session.state().forest.root(0);
  EXPECT_LE(root, 2U);
  EXPECT_EQ(vertices.host(4), root);
  EXPECT_EQ(vertices.host(5), root);
  EXPECT_EQ(session.state().forest.key(5).b, 5U);
  session.expect_invariants();
}

TEST(Replay, AHostThatLeavesIsFollowedByAGuest) {
  auto session = row({100, 110, 120, 130});
  session.update({0, 1, 2, 3, 4}, {});
  for (const PointIndex x : {0U, 4U, 1U, 3U}) {
    session.update({}, {x});
    session.expect_invariants();
  }
  EXPECT_EQ(session.state().forest.root(2), 2U);
  EXPECT_EQ(session.state().forest.history().final_theta(2), Session::kRule.threshold);
}

/// Four points in a square: edges 0 - 1 of 10, 1 - 2 and 0 - 3 of about 40, 2 - 3 of 70.
Session square() {
  fuzz::WeightedLattice lattice;
  lattice.add({1, 0}, 0, 10e-6);
  lattice.add({1, 1}, 1, 40e-6);
  lattice.add({0, 1}, 2, 70e-6);
  return Session(lattice.points());
}

TEST(Replay, AnEdgeThatWasInsideIsFoundAgainWhenTheTreeFallsApart) {
  auto session = square();
  session.update({0, 1, 2, 3}, {});
  EXPECT_EQ(session.replay().num_explored(), 0);
  session.update({}, {0});
  EXPECT_TRUE(are_one(session, 2, 3));
  EXPECT_EQ(session.replay().num_explored(), 1);
  session.expect_invariants();
}

TEST(Replay, APointOutsideTheTreeChangesNothingButSizes) {
  auto session = square();
  session.update({0, 1, 2, 3}, {});
  session.update({}, {3});
  EXPECT_EQ(session.replay().num_explored(), 0);
  EXPECT_EQ(session.replay().num_joins(), 0);
  session.expect_invariants();
}

TEST(Replay, AnEmptyChangeDoesNothing) {
  auto session = square();
  session.update({0, 1, 2, 3}, {});
  session.update({}, {});
  EXPECT_EQ(session.replay().num_events(), 0);
  EXPECT_TRUE(session.names().changed().empty());
  session.expect_invariants();
}

TEST(Replay, GivesUpWhereMoreIsToBeExploredThanAllowed) {
  auto session = square();
  session.update({0, 1, 2, 3}, {});
  EXPECT_FALSE(session.update({}, {0}, 0));
  session.rebuild({}, {0});
  session.expect_invariants();
  EXPECT_TRUE(session.update({0}, {}, 0));
  session.expect_invariants();
}

TEST(Replay, CostsWhatTheSmallerSideHas) {
  // A point near the end of a long row leaves: the few at the end are looked at, not the many.
  fuzz::WeightedLattice lattice;
  const std::vector<double> weights(400, 0.0);
  lattice.add_row(0, {1, 0}, weights);
  Session session(lattice.points());
  Points all(lattice.size());
  std::iota(all.begin(), all.end(), 0);
  session.update(all, {});
  ASSERT_TRUE(are_one(session, 0, 400));
  session.update({}, {396});
  EXPECT_FALSE(are_one(session, 0, 400));
  EXPECT_LE(session.replay().num_explored(), 4);
  EXPECT_LE(session.names().changed().size(), 4U);
}

TEST(Replay, AFrozenComponentBlocksAllItsWatchesAtOnce) {
  // A row that freezes at about 150, and beside it points it cannot join. When it grows, one look
  // at its first watch tells as much.
  fuzz::WeightedLattice lattice;
  const std::vector<double> weights(20, 100e-6);
  lattice.add_row(0, {1, 0}, weights);
  for (PointIndex x = 0; x <= 20; x += 2) lattice.add({static_cast<int>(x), 1}, x, 900e-6);
  const PointIndex newcomer = lattice.add({-1, 0}, 0, 100e-6);
  Session session(lattice.points());
  Points others(newcomer);
  std::iota(others.begin(), others.end(), 0);
  session.update(others, {});
  EXPECT_EQ(session.state().watches.size(), 11U);
  session.update({newcomer}, {});
  EXPECT_TRUE(are_one(session, newcomer, 20));
  EXPECT_LE(session.replay().num_events(), 3);
  EXPECT_EQ(session.state().watches.size(), 11U);
  session.expect_invariants();
}

/// Points come, go, do both at once, and the state is built anew at times.
class ReplaySession : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  /// Each point of the wanted kind with the probability `share`.
  Points draw(const Session& session, PointIndex size, bool is_in, double share) {
    Points drawn;
    for (PointIndex x = 0; x < size; ++x) {
      if (session.is_in(x) == is_in && random_.chance(share)) drawn.push_back(x);
    }
    return drawn;
  }

  fuzz::Random random_{GetParam()};
};

TEST_P(ReplaySession, KeepsTheInvariants) {
  for (int n = 0; n < 12; ++n) {
    const std::vector<CloudPoint> pool_W = fuzz::random_cloud(random_, random_.between(5, 70), {});
    const auto size = static_cast<PointIndex>(pool_W.size());
    Session session(pool_W);
    for (int step = 0; step < 25; ++step) {
      const double coming = random_.chance(0.7) ? random_.log_uniform(0.01, 0.6) : 0.0;
      const double going = random_.chance(0.6) ? random_.log_uniform(0.01, 0.3) : 0.0;
      const Points added = draw(session, size, false, coming);
      const Points removed = draw(session, size, true, going);
      const std::int64_t max_explored = random_.chance(0.2) ? 3 : INT64_MAX;
      if (!session.update(added, removed, max_explored)) session.rebuild(added, removed);
      session.expect_invariants();
      ASSERT_FALSE(HasFailure()) << "cloud " << n << ", step " << step;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ReplaySession, ::testing::Range<std::uint64_t>(0, 10));

}  // namespace
}  // namespace kintsugi::segmenter::exact

// What incremental segmentation gets wrong most easily, each in the smallest map that has it.
// Weights are in microunits: T is 1000, k is 500, theta of n points last joined at w is w + 500 /
// n.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/graph/edge_weight.hpp"
#include "segmenter/core/make_engine.hpp"
#include "tests/fuzz/changing_cloud.hpp"
#include "tests/fuzz/engine_check.hpp"
#include "tests/fuzz/partition.hpp"
#include "tests/fuzz/random.hpp"
#include "tests/fuzz/run_scenario.hpp"
#include "tests/fuzz/weighted_lattice.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter::fuzz {
namespace {

using Points = std::vector<PoolIndex>;

constexpr double kMicro = 1e-6;

std::vector<double> micro(std::vector<double> weights) {
  for (double& weight : weights) weight *= kMicro;
  return weights;
}

constexpr const char* kModeUnderTest = "exact";

/// [first, last).
Points range(PoolIndex first, PoolIndex last) {
  Points points(last - first);
  std::iota(points.begin(), points.end(), first);
  return points;
}

Points all_of(const std::vector<CloudPoint>& pool) {
  return range(0, static_cast<PoolIndex>(pool.size()));
}

void expect_equals_batch(const Scenario& scenario) {
  const Outcome outcome = run_scenario(scenario, engine_factory(kModeUnderTest));
  EXPECT_EQ(outcome.failure, std::nullopt) << "after step " << outcome.num_steps;
  EXPECT_EQ(outcome.num_steps, scenario.steps.size());
}

/// All points at once; then each leaves and comes back to its place.
Scenario each_leaves_and_returns(std::vector<CloudPoint> pool) {
  Scenario scenario{.config = {}, .pool = std::move(pool), .steps = {}};
  scenario.steps.push_back({.add = all_of(scenario.pool), .remove = {}});
  for (const PoolIndex i : all_of(scenario.pool)) {
    scenario.steps.push_back({.add = {}, .remove = {i}});
    scenario.steps.push_back({.add = {i}, .remove = {}});
  }
  return scenario;
}

std::vector<CloudPoint> without(std::vector<CloudPoint> points, PoolIndex i) {
  points.erase(points.begin() + i);
  return points;
}

// The builder of such maps.

TEST(WeightedLattice, HasTheWeightsWantedAndNoOtherEdges) {
  WeightedLattice lattice;
  const auto row = micro({100, 900, 0, 1499});
  const PoolIndex end = lattice.add_row(0, {1, 0}, row);
  const PoolIndex twig = lattice.add({2, 1}, 2, 300 * kMicro);
  const std::vector<CloudPoint>& points = lattice.points();
  // Normals are rounded to float32: 2^-24 each.
  constexpr double kRounding = 2e-7;
  const float radius_m = EngineConfig().radius_m();
  int num_edges = 0;
  for (PoolIndex i = 0; i < points.size(); ++i) {
    for (PoolIndex j = i + 1; j < points.size(); ++j) {
      if (!are_neighbours(points[i], points[j], radius_m)) continue;
      ++num_edges;
      const double wanted = j == twig ? 300 * kMicro : row[i];
      EXPECT_NEAR(EdgeWeight()(points[i], points[j]), wanted, kRounding);
    }
  }
  EXPECT_EQ(num_edges, 5);
  EXPECT_EQ(end, 4U);
}

TEST(WeightedLattice, ClosesASquareWithEqualSumsOfOppositeWeights) {
  WeightedLattice lattice;
  lattice.add({1, 0}, 0, 100 * kMicro);
  lattice.add({1, 1}, 1, 400 * kMicro);
  lattice.add({0, 1}, 2, 700 * kMicro);
  // The products of two weights, up to 3e-7, are neglected.
  EXPECT_NEAR(EdgeWeight()(lattice.points()[0], lattice.points()[3]), 400 * kMicro, 1e-6);
}

// The pitfalls.

TEST(ExactPitfalls, ThetasDifferWhileLabelsAgree) {
  // The last point joins at 400 or at 410: the same segment, another theta; and without it the
  // others stay together and have yet another.
  auto pool = chain_of_weights(micro({100, 200, 300, 400}));
  pool.push_back(chain_of_weights(micro({100, 200, 300, 410})).back());
  const EngineConfig config;
  const Partition before = batch_partition(without(pool, 5), config);
  const Partition after = batch_partition(without(pool, 4), config);
  ASSERT_EQ(before.labels, after.labels);
  ASSERT_NE(before.thetas, after.thetas);

  expect_equals_batch({.config = config,
                       .pool = pool,
                       .steps = {{.add = range(0, 5), .remove = {}},
                                 {.add = {5}, .remove = {4}},
                                 {.add = {}, .remove = {5}},
                                 {.add = {4}, .remove = {}}}});
}

/// Three groups of four in a row, H - G - C, each of two pairs and alive up to about 675. G joins H
/// at `w_HG`, C joins G at `w_GC`; points that come later beside G make it freeze before.
WeightedLattice three_groups(double w_HG, double w_GC, int num_twigs, double w_twig) {
  WeightedLattice lattice;
  PoolIndex last = lattice.add_row(0, {1, 0}, micro({540, 550, 545, w_HG}));
  const PoolIndex first_of_G = last;
  last = lattice.add_row(last, {1, 0}, micro({541, 551, 546, w_GC}));
  lattice.add_row(last, {1, 0}, micro({530, 548, 535}));
  PoolIndex up = first_of_G;
  PoolIndex down = first_of_G + 2;
  for (int k = 0; k < num_twigs; ++k) {
    PoolIndex& end = k % 2 == 0 ? up : down;
    end = lattice.add_row(end, {0, k % 2 == 0 ? 1 : -1}, micro({w_twig + k}));
  }
  return lattice;
}

TEST(ExactPitfalls, ATentativeJoinHangsOnAVertexOfADetachedPiece) {
  // G leaves H because it has frozen by then; C had joined H through a vertex of G, sooner or
  // later than G did.
  bool has_left = false;
  for (const double w_HG : {570, 600, 620, 650}) {
    for (const double w_GC : {560, 595, 610, 640}) {
      for (const double w_twig : {300, 555, 580, 605}) {
        for (const int num_twigs : {1, 3, 10}) {
          const auto pool = three_groups(w_HG, w_GC, num_twigs, w_twig).points();
          const auto num_twigs_in_pool = static_cast<PoolIndex>(num_twigs);
          const PoolIndex size = static_cast<PoolIndex>(pool.size());
          const Points twigs = range(size - num_twigs_in_pool, size);
          const std::vector<CloudPoint> groups(pool.begin(), pool.end() - num_twigs);
          const Partition together = batch_partition(groups, {});
          const Partition apart = batch_partition(pool, {});
          has_left |= together.labels[4] == 0 && apart.labels[4] != 0;

          Scenario scenario{.config = {}, .pool = pool, .steps = {}};
          scenario.steps.push_back({.add = range(0, size - num_twigs_in_pool), .remove = {}});
          scenario.steps.push_back({.add = twigs, .remove = {}});
          scenario.steps.push_back({.add = {}, .remove = twigs});
          for (const PoolIndex i : twigs) scenario.steps.push_back({.add = {i}, .remove = {}});
          for (const PoolIndex i : twigs) scenario.steps.push_back({.add = {}, .remove = {i}});
          expect_equals_batch(scenario);
        }
      }
    }
  }
  EXPECT_TRUE(has_left);  // or the maps would not be worth the test
}

/// A full lattice whose weights are spread over (0, `most`), all of them arbitrary.
std::vector<CloudPoint> arbitrary_lattice(Random& random, int width, int height, double most) {
  // Lengths 1 + b and 1 - b' beside each other weigh about b' - b.
  std::vector<CloudPoint> points;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      WeightedLattice site({x, y});
      CloudPoint p = site.points().front();
      const double b = 0.5 * most * random.unit();
      p.nz = static_cast<float>((x + y) % 2 == 0 ? 1.0 + b : 1.0 - 0.5 * most - b);
      points.push_back(p);
    }
  }
  return points;
}

TEST(ExactPitfalls, AnEnumeratedSideContainsAHost) {
  // In a mesh each segment has many edges that are not of its tree. Whatever point leaves, the
  // pieces of the tree find one another again through these, and the smaller piece may well be the
  // one that others had joined.
  Random random(1);
  for (int k = 0; k < 40; ++k) {
    const double most = random.log_uniform(200, 3000) * kMicro;
    expect_equals_batch(each_leaves_and_returns(arbitrary_lattice(random, 3 + k % 3, 4, most)));
  }
}

TEST(ExactPitfalls, WatchEntriesMadeDuringASliceStayOutOfTheOldHeap) {
  // A (frozen from 675 on) watches its edge to B at 700. Points that come to A, all in one slice or
  // one by one in any order, freeze it sooner; edges at 640 and 660 are watched from then on, by A
  // or by the newcomer, while A's heap is being looked through.
  WeightedLattice lattice;
  const PoolIndex end_of_A = lattice.add_row(0, {1, 0}, micro({540, 550, 545}));
  lattice.add_row(end_of_A, {1, 0}, micro({700, 530, 552, 535}));
  const PoolIndex size = lattice.size();
  Points newcomers;
  newcomers.push_back(lattice.add({0, 1}, 0, 640 * kMicro));
  newcomers.push_back(lattice.add({1, -1}, 1, 560 * kMicro));
  newcomers.push_back(lattice.add({2, 1}, 2, 660 * kMicro));
  newcomers.push_back(lattice.add({3, -1}, 3, 600 * kMicro));
  Scenario scenario{.config = {}, .pool = lattice.points(), .steps = {}};
  scenario.steps.push_back({.add = range(0, size), .remove = {}});
  do {
    for (const PoolIndex i : newcomers) scenario.steps.push_back({.add = {i}, .remove = {}});
    scenario.steps.push_back({.add = {}, .remove = newcomers});
    scenario.steps.push_back({.add = newcomers, .remove = {}});
    for (const PoolIndex i : newcomers) scenario.steps.push_back({.add = {}, .remove = {i}});
  } while (std::ranges::next_permutation(newcomers).found);
  expect_equals_batch(scenario);
}

TEST(ExactPitfalls, ManyPointsLeaveAtOneSpot) {
  const auto pool = testing::random_cloud(testing::CloudShape::kWaves, 600, 4);
  Scenario scenario{.config = {}, .pool = pool, .steps = {}};
  scenario.steps.push_back({.add = all_of(pool), .remove = {}});
  for (const float radius_m : {0.02F, 0.05F, 0.08F, 0.15F}) {
    for (const PoolIndex centre : {0U, 150U, 300U, 450U}) {
      Points spot;
      for (const PoolIndex i : all_of(pool)) {
        if (are_neighbours(pool[i], pool[centre], radius_m)) spot.push_back(i);
      }
      scenario.steps.push_back({.add = {}, .remove = spot});
      scenario.steps.push_back({.add = spot, .remove = {}});
    }
  }
  expect_equals_batch(scenario);
}

TEST(ExactPitfalls, TheRepresentativeOfTheLargestSegmentLeaves) {
  // Whichever point that is: each of them leaves once, and a sheet keeps together without it.
  auto pool = testing::random_cloud(testing::CloudShape::kWaves, 250, 2);
  const Partition partition = batch_partition(pool, {});
  std::vector<int> sizes(pool.size(), 0);
  for (const PointIndex label : partition.labels) ++sizes[label];
  ASSERT_GT(std::ranges::max(sizes), 30);
  expect_equals_batch(each_leaves_and_returns(std::move(pool)));
}

TEST(ExactPitfalls, ABridgeBetweenTwoHalvesLeavesAndReturns) {
  // Two patches of one weight, a bridge of three points between them.
  WeightedLattice lattice;
  const auto row = micro({50, 50, 50, 50});
  const auto patch = [&](PoolIndex corner) {
    const PoolIndex lower_right = lattice.add_row(corner, {1, 0}, row);
    for (int y = 1; y < 5; ++y) {
      corner = lattice.add_row(corner, {0, 1}, micro({50}));
      lattice.add_row(corner, {1, 0}, row);
    }
    return lower_right;
  };
  const PoolIndex quay = patch(0);
  const PoolIndex first = lattice.size();
  const PoolIndex bridge = lattice.add_row(quay, {1, 0}, micro({50, 60, 55}));
  const PoolIndex last = lattice.size();
  patch(lattice.add_row(bridge, {1, 0}, micro({50})));
  const auto& pool = lattice.points();
  ASSERT_EQ(batch_partition(pool, {}).labels.back(), 0U);

  Scenario scenario{.config = {}, .pool = pool, .steps = {}};
  scenario.steps.push_back({.add = all_of(pool), .remove = {}});
  for (PoolIndex i = first; i < last; ++i) {
    scenario.steps.push_back({.add = {}, .remove = {i}});
    scenario.steps.push_back({.add = {i}, .remove = {}});
  }
  scenario.steps.push_back({.add = {}, .remove = range(first, last)});
  scenario.steps.push_back({.add = range(first, last), .remove = {}});
  scenario.steps.push_back({.add = {}, .remove = range(0, first)});
  scenario.steps.push_back({.add = range(0, first), .remove = {}});
  expect_equals_batch(scenario);
}

TEST(ExactPitfalls, APointLeavesAndComesToItsPlaceInOneUpdate) {
  auto pool = testing::random_cloud(testing::CloudShape::kUnrelated, 60, 3);
  const auto num_places = static_cast<PoolIndex>(pool.size());
  pool.insert(pool.end(), pool.begin(), pool.begin() + num_places);  // twins
  Scenario scenario{.config = {}, .pool = pool, .steps = {}};
  const Points first = range(0, num_places);
  const Points twins = range(num_places, 2 * num_places);
  scenario.steps.push_back({.add = first, .remove = {}});
  for (const PoolIndex i : first) {
    scenario.steps.push_back({.add = {i}, .remove = {i}});
    scenario.steps.push_back({.add = {i + num_places}, .remove = {i}});
  }
  scenario.steps.push_back({.add = first, .remove = twins});
  scenario.steps.push_back({.add = first, .remove = first});
  expect_equals_batch(scenario);
}

TEST(ExactPitfalls, EqualWeightsEverywhere) {
  for (const double weight : {0.0, 10.0, 400.0, 999.0, 1000.0, 1300.0}) {
    // Rows of a chessboard: every edge is between a white and a black site.
    WeightedLattice lattice;
    PoolIndex corner = 0;
    for (int y = 0; y < 6; ++y) {
      PoolIndex row = corner;
      for (int x = 1; x < 7; ++x) row = lattice.add({x, y}, row, weight * kMicro);
      if (y < 5) corner = lattice.add({0, y + 1}, corner, weight * kMicro);
    }
    expect_equals_batch(each_leaves_and_returns(lattice.points()));
    Scenario one_by_one{.config = {}, .pool = lattice.points(), .steps = {}};
    for (const PoolIndex i : all_of(lattice.points())) {
      one_by_one.steps.push_back({.add = {i}, .remove = {}});
    }
    expect_equals_batch(one_by_one);
  }
}

TEST(ExactPitfalls, ManyPointsShareOnePlace) {
  auto pool = testing::random_cloud(testing::CloudShape::kUnrelated, 80, 8);
  for (CloudPoint& p : pool) p.x = p.y = p.z = 0.25F;
  expect_equals_batch(each_leaves_and_returns(pool));
  for (CloudPoint& p : pool) p = pool.front();
  expect_equals_batch(each_leaves_and_returns(pool));
}

TEST(ExactPitfalls, CorrectionsLeaveMemoryFlat) {
  // A piece moves and moves back. The engine's arrays grow by 2 MB: 400 updates that each lost a
  // word for each point of the piece would show.
  Scenario scenario{.config = {.rebuild_share = 1e9},
                    .pool = testing::random_cloud(testing::CloudShape::kWaves, 2000, 6),
                    .steps = {}};
  std::vector<CloudPoint>& pool = scenario.pool;
  const Points all = all_of(pool);
  Points piece;
  Points moved;
  for (const PoolIndex i : all) {
    if (pool[i].x > 0.15F) continue;
    piece.push_back(i);
    moved.push_back(static_cast<PoolIndex>(pool.size()));
    pool.push_back(pool[i]);
    pool.back().z += 0.004F;
  }
  ASSERT_GT(piece.size(), 600U);
  scenario.slice_points = 50;

  ChangingCloud map(scenario);
  const auto engine = make_engine(kModeUnderTest, map.cloud(), scenario.config);
  engine->update(map.apply({.add = all, .remove = {}}));
  std::size_t bytes = 0;
  PointIndex num_places = 0;
  for (int round = 0; round < 200; ++round) {
    engine->update(map.apply({.add = moved, .remove = piece}));
    engine->update(map.apply({.add = piece, .remove = moved}));
    if (round == 9) {
      bytes = engine->bytes();
      num_places = map.cloud().size();
    }
  }
  EXPECT_LE(engine->bytes(), bytes);
  EXPECT_LE(map.cloud().size(), num_places);
  EngineCheck check(*engine, map.cloud(), scenario.config);
  EXPECT_EQ(check.partition(map.live()), std::nullopt);
}

TEST(ExactPitfalls, EverythingLeavesAndReturns) {
  const auto pool = testing::random_cloud(testing::CloudShape::kLattice, 200, 5);
  const Points all = all_of(pool);
  expect_equals_batch({.config = {},
                       .pool = pool,
                       .steps = {{},
                                 {.add = all, .remove = {}},
                                 {},
                                 {.add = {}, .remove = all},
                                 {},
                                 {.add = all, .remove = {}},
                                 {.add = all, .remove = all}}});
}

}  // namespace
}  // namespace kintsugi::segmenter::fuzz

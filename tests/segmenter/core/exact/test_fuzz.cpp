// Random maps in which points come, go and move; after every step labels and thetas equal batch.
// scripts/fuzz does the same for longer.

#include <algorithm>
#include <iostream>
#include <sstream>

#include <gmock/gmock.h>

#include "segmenter/core/make_engine.hpp"
#include "tests/bench/map_generator.hpp"
#include "tests/fuzz/changing_cloud.hpp"
#include "tests/fuzz/faulty_engine.hpp"
#include "tests/fuzz/isolated_run.hpp"
#include "tests/fuzz/partition.hpp"
#include "tests/fuzz/random_scenario.hpp"
#include "tests/fuzz/shrink.hpp"
#include "tests/segmenter/core/literal_segmentation.hpp"

namespace kintsugi::segmenter::fuzz {
namespace {

using ::testing::HasSubstr;
using ::testing::Optional;

constexpr ScenarioBounds kSmall = {.min_points = 5, .max_points = 80, .max_steps = 12};

const EngineFactory kRightEngine = engine_factory("batch");

// The harness itself.

TEST(Harness, FindsNothingWrongWithBatch) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Scenario scenario = random_scenario(seed, kSmall, {});
    const Outcome outcome = run_scenario(scenario, kRightEngine);
    EXPECT_EQ(outcome.num_steps, scenario.steps.size());
    EXPECT_EQ(outcome.failure, std::nullopt) << "seed " << seed;
  }
}

TEST(Harness, ComparesWithTheLiteralAlgorithm) {
  int num_compared = 0;
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    const Scenario scenario = random_scenario(seed, kSmall, {});
    ChangingCloud map(scenario);
    for (const Step& step : scenario.steps) map.apply(step);
    std::vector<CloudPoint> points_W;
    for (const PointIndex i : map.live()) points_W.push_back(map.cloud()[i]);
    const Partition partition = batch_partition(points_W, scenario.config);
    const auto literal = testing::literal_batch(points_W, {.T = scenario.config.threshold,
                                                           .k = scenario.config.scale,
                                                           .lambda = scenario.config.color_weight});
    for (std::size_t k = 0; k < points_W.size(); ++k, ++num_compared) {
      const testing::LiteralSegment& segment = *literal.of.at(static_cast<int>(k));
      ASSERT_EQ(partition.labels[k], static_cast<PointIndex>(*segment.d.begin()));
      ASSERT_EQ(partition.thetas[k], segment.theta);
    }
  }
  EXPECT_GT(num_compared, 500);
}

struct FaultCase {
  Fault fault;
  const char* message;
};

class HarnessFault : public ::testing::TestWithParam<FaultCase> {};

TEST_P(HarnessFault, IsFound) {
  const auto [fault, message] = GetParam();
  int num_found = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const Scenario scenario = random_scenario(seed, kSmall, {});
    const auto spoilt = run_scenario(scenario, faulty(kRightEngine, fault, seed % 5));
    if (!spoilt.failure) continue;  // no step left room for the fault
    ++num_found;
    EXPECT_GT(spoilt.num_steps, seed % 5);
    EXPECT_THAT(spoilt.failure, Optional(HasSubstr(message))) << "seed " << seed;
  }
  EXPECT_GT(num_found, 15);
}

INSTANTIATE_TEST_SUITE_P(Faults, HarnessFault,
                         ::testing::Values(FaultCase{Fault::kWrongLabel, "differ from batch"},
                                           FaultCase{Fault::kWrongTheta, " 0 labels and "},
                                           FaultCase{Fault::kGoneStays, "is gone but in component"},
                                           FaultCase{Fault::kChangeLeftOut, "changed() has"},
                                           FaultCase{Fault::kChangeMadeUp, "changed() has"},
                                           FaultCase{Fault::kNameOutOfRange, "is in component"},
                                           FaultCase{Fault::kThrows, "threw: a fault"}),
                         [](const auto& test) {
                           return "Number" + std::to_string(static_cast<int>(test.param.fault));
                         });

TEST(Harness, MakesAFailingScenarioSmall) {
  const Scenario scenario = random_scenario(3, kSmall, {});
  const auto fails = [](const Scenario& s) {
    return run_scenario(s, faulty(kRightEngine, Fault::kGoneStays, 0)).failure.has_value();
  };
  ASSERT_TRUE(fails(scenario));
  const Scenario smallest = shrink(scenario, fails, 1000);
  EXPECT_TRUE(fails(smallest));
  EXPECT_EQ(smallest.pool.size(), 1U);  // it comes, and it goes
  EXPECT_EQ(smallest.steps.size(), 2U);
}

TEST(Harness, WritesAScenarioThatReadsBackTheSame) {
  const Scenario scenario = random_scenario(1, kSmall, {});
  std::stringstream text;
  write_scenario(text, scenario);
  const Scenario read = read_scenario(text);
  EXPECT_EQ(read.pool, scenario.pool);
  EXPECT_EQ(read.config.threshold, scenario.config.threshold);
  EXPECT_EQ(read.config.scale, scenario.config.scale);
  EXPECT_EQ(read.slice_points, scenario.slice_points);
  ASSERT_EQ(read.steps.size(), scenario.steps.size());
  for (std::size_t s = 0; s < read.steps.size(); ++s) {
    EXPECT_EQ(read.steps[s].add, scenario.steps[s].add);
    EXPECT_EQ(read.steps[s].remove, scenario.steps[s].remove);
  }
}

TEST(Harness, RefusesWhatIsNoScenario) {
  std::istringstream text(
      "config 0.001 0.0005 0.003 0 0.85 0.01 2 1 1 0\nslice_points 1\npoints 0\nsteps 1\nremove 1 "
      "7\n");
  EXPECT_THAT([&] { read_scenario(text); },
              ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("point 7 of 0")));
}

TEST(Harness, SurvivesAnEngineThatDoesNot) {
  const Outcome crash = run_isolated([]() -> Outcome { std::abort(); }, 10);
  EXPECT_THAT(crash.failure, Optional(HasSubstr("Aborted")));
  const Outcome outcome = run_isolated([] { return Outcome{7, 2, "two words"}; }, 10);
  EXPECT_EQ(outcome.num_steps, 7U);
  EXPECT_EQ(outcome.num_rebuilt, 2U);
  EXPECT_THAT(outcome.failure, Optional(std::string("two words")));
}

TEST(RandomScenario, DoesEverythingThatItPromises) {
  std::size_t num_steps = 0;
  std::size_t num_empty = 0;      // nothing comes or goes
  std::size_t num_exchanges = 0;  // points come and go
  std::size_t num_clearings = 0;  // the last point leaves
  std::size_t num_returns = 0;    // a point comes to its old place
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Scenario scenario = random_scenario(seed, kSmall, {});
    ChangingCloud map(scenario);
    std::vector<bool> was_in(scenario.pool.size(), false);
    for (const Step& step : scenario.steps) {
      ++num_steps;
      num_empty += step.add.empty() && step.remove.empty();
      num_exchanges += !step.add.empty() && !step.remove.empty();
      map.apply(step);
      num_clearings += !step.remove.empty() && map.live().empty();
      for (const PoolIndex i : step.add) {
        num_returns += was_in[i];
        was_in[i] = true;
      }
    }
  }
  EXPECT_GT(num_empty, num_steps / 100);
  EXPECT_GT(num_exchanges, num_steps / 10);
  EXPECT_GT(num_clearings, 10U);
  EXPECT_GT(num_returns, num_steps / 5);
}

// The engine.

/// Runs `num_scenarios` and prints how many steps were checked; stops at the first failure.
void expect_equals_batch(std::uint64_t first_seed, int num_scenarios, const ScenarioBounds& bounds,
                         std::span<const CloudPoint> map_W = {}) {
  std::size_t num_steps = 0;
  std::size_t num_rebuilt = 0;
  for (int k = 0; k < num_scenarios; ++k) {
    const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(k);
    const Scenario scenario = random_scenario(seed, bounds, map_W);
    const Outcome outcome = run_scenario(scenario, engine_factory("exact"));
    num_steps += outcome.num_steps;
    num_rebuilt += outcome.num_rebuilt;
    ASSERT_EQ(outcome.failure, std::nullopt)
        << "seed " << seed << ", step " << outcome.num_steps << " of " << scenario.steps.size();
  }
  std::cout << num_steps << " steps of " << num_scenarios << " scenarios equal batch, "
            << num_rebuilt << " of them built anew\n";
  EXPECT_LT(num_rebuilt, num_steps / 3);  // or there would be little to learn
}

TEST(ExactFuzz, EqualsBatchInTinyMaps) {
  expect_equals_batch(10'000, 400, {.min_points = 3, .max_points = 40, .max_steps = 30});
}

TEST(ExactFuzz, EqualsBatchInSmallMaps) {
  expect_equals_batch(20'000, 240, {.min_points = 40, .max_points = 400, .max_steps = 40});
}

TEST(ExactFuzz, EqualsBatchInMaps) {
  expect_equals_batch(30'000, 100, {.min_points = 400, .max_points = 3000, .max_steps = 40});
}

TEST(ExactFuzz, EqualsBatchInPiecesOfRooms) {
  const auto map_W = bench::all_points(bench::generate_map({.num_points = 60'000, .num_rooms = 2}));
  expect_equals_batch(40'000, 200, {.min_points = 40, .max_points = 2000, .max_steps = 40}, map_W);
}

}  // namespace
}  // namespace kintsugi::segmenter::fuzz

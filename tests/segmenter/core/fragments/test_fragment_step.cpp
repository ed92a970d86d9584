// The fragment step of mode batch: compared with its transcription, and in small cases.

#include <cmath>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "segmenter/core/batch/batch_engine.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "tests/fuzz/changing_cloud.hpp"
#include "tests/fuzz/partition.hpp"
#include "tests/fuzz/random.hpp"
#include "tests/fuzz/random_scenario.hpp"
#include "tests/fuzz/weighted_lattice.hpp"
#include "tests/segmenter/core/fragments/literal_fragments.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr fuzz::ScenarioBounds kSmall = {.min_points = 5, .max_points = 150, .max_steps = 10};

std::vector<PointIndex> labels_at(std::span<const ComponentId> components,
                                  std::span<const PointIndex> live) {
  std::vector<ComponentId> of_live;
  for (const PointIndex i : live) of_live.push_back(components[i]);
  const std::vector<PointIndex> labels = canonical_labels(components);
  std::map<PointIndex, PointIndex> place;  // of the first point of each, among the live ones
  std::vector<PointIndex> result;
  for (PointIndex k = 0; k < live.size(); ++k) {
    result.push_back(place.try_emplace(labels[live[k]], k).first->second);
  }
  return result;
}

TEST(FragmentStep, IsWhatItsTranscriptionDoes) {
  int num_joined = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    fuzz::Scenario scenario = fuzz::random_scenario(seed, kSmall, {});
    fuzz::Random random(seed);
    EngineConfig& config = scenario.config;
    config.min_points = std::floor(random.log_uniform(1.0, 200.0));
    fuzz::ChangingCloud map(scenario);
    BatchEngine engine(map.cloud(), config);
    for (const fuzz::Step& step : scenario.steps) {
      engine.update(map.apply(step));
      const std::vector<PointIndex> live = map.live();
      const auto literal = testing::literal_fragment_step(
          map.cloud(), live, engine.unmerged_components(), config.radius_m(),
          config.fragment_limit(), config.color_weight);
      ASSERT_EQ(labels_at(engine.components(), live), literal) << "seed " << seed;
      num_joined += labels_at(engine.unmerged_components(), live) != literal;
    }
  }
  EXPECT_GT(num_joined, 100);
}

/// A chain of points whose edges have these weights.
class FragmentChain : public ::testing::Test {
 protected:
  std::vector<PointIndex> labels(std::initializer_list<double> weights, double min_points) {
    const std::vector<CloudPoint> points_W = fuzz::chain_of_weights(std::vector(weights));
    PointCloud cloud;
    cloud.add_slice(0, points_W);
    engine_ = std::make_unique<BatchEngine>(cloud, EngineConfig{.min_points = min_points});
    engine_->update(cloud.take_change());
    return canonical_labels(engine_->components());
  }
  std::unique_ptr<BatchEngine> engine_;
};

// Two segments of three points, a single point nearer to the second.
TEST_F(FragmentChain, JoinsAFragmentToTheNeighbourItIsMostLike) {
  EXPECT_EQ(labels({1e-6, 1e-6, 5e-3, 4e-3, 1e-6, 1e-6}, 2),
            (std::vector<PointIndex>{0, 0, 0, 3, 3, 3, 3}));
}

TEST_F(FragmentChain, LeavesLargeSegmentsApart) {
  EXPECT_EQ(labels({1e-6, 1e-6, 5e-3, 1e-6, 1e-6}, 3), (std::vector<PointIndex>{0, 0, 0, 3, 3, 3}));
  EXPECT_EQ(labels({1e-6, 1e-6, 5e-3, 1e-6, 1e-6}, 4), (std::vector<PointIndex>(6, 0)));
}

// Fragments that join each other first are large then, and do not join the segments beside them.
TEST_F(FragmentChain, JoinsFragmentsToEachOther) {
  EXPECT_EQ(labels({1e-6, 5e-3, 3e-3, 5e-3, 1e-6}, 2), (std::vector<PointIndex>{0, 0, 2, 2, 4, 4}));
}

TEST_F(FragmentChain, LeavesWhatHasNoNeighbourAFragment) {
  EXPECT_EQ(labels({5e-3, 4e-3}, 50), (std::vector<PointIndex>{0, 0, 0}));
}

TEST_F(FragmentChain, CallsASegmentAfterItsLargePart) {
  labels({5e-3, 1e-6, 1e-6}, 3);
  EXPECT_EQ(engine_->components()[0], engine_->components()[2]);
  EXPECT_EQ(engine_->components()[0], engine_->unmerged_components()[2]);
  EXPECT_EQ(engine_->theta(engine_->components()[0]),
            engine_->theta(engine_->unmerged_components()[2]));
}

TEST_F(FragmentChain, DoesNothingWithoutALimit) {
  EXPECT_EQ(labels({5e-3, 4e-3}, 0), (std::vector<PointIndex>{0, 1, 2}));
  EXPECT_EQ(labels({5e-3, 4e-3}, 1), (std::vector<PointIndex>{0, 1, 2}));
}

}  // namespace
}  // namespace kintsugi::segmenter

// The fragment layer, compared after each update with the transcription of the fragment step.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/core/make_engine.hpp"
#include "tests/fuzz/changing_cloud.hpp"
#include "tests/fuzz/random.hpp"
#include "tests/fuzz/random_scenario.hpp"
#include "tests/fuzz/weighted_lattice.hpp"
#include "tests/segmenter/core/fragments/literal_fragments.hpp"

namespace kintsugi::segmenter {
namespace {

struct LayerCase {
  const char* mode;
  NeighbourSearch search;
  double rebuild_share;  ///< 0: every update finds all clusters again
};

class FragmentLayerIn : public ::testing::TestWithParam<LayerCase> {
 protected:
  void use(const EngineConfig& config, const PointCloud& cloud) {
    config_ = config;
    config_.neighbour_search = GetParam().search;
    config_.rebuild_share = GetParam().rebuild_share;
    cloud_ = &cloud;
    engine_ = make_engine(GetParam().mode, cloud, config_);
    mirror_.clear();
  }

  void update(const CloudChange& change) {
    engine_->update(change);
    mirror_.resize(cloud_->size(), kNoComponent);
    for (const PointIndex i : change.removed) mirror_[i] = kNoComponent;
    for (const PointIndex i : change.added) mirror_[i] = kNoComponent;
    for (const PointIndex i : engine_->changed()) {
      EXPECT_NE(mirror_[i], engine_->components()[i]);
      mirror_[i] = engine_->components()[i];
    }
  }

  void expect_literal(std::span<const PointIndex> live) const {
    const std::span<const ComponentId> components = engine_->components();
    ASSERT_EQ(mirror_, std::vector(components.begin(), components.end()));
    const std::vector<PointIndex> literal = testing::literal_fragment_step(
        *cloud_, live, engine_->unmerged_components(), config_.radius_m(), config_.fragment_limit(),
        config_.color_weight);
    const std::vector<PointIndex> labels = canonical_labels(components);
    for (std::size_t k = 0; k < live.size(); ++k) {
      ASSERT_EQ(labels[live[k]], live[literal[k]]) << "point " << live[k];
    }
  }

  EngineConfig config_;
  const PointCloud* cloud_ = nullptr;
  std::unique_ptr<SegmentationEngine> engine_;
  std::vector<ComponentId> mirror_;  ///< components(), updated only at the points in changed()
};

TEST_P(FragmentLayerIn, EqualsTheTranscriptionAfterEachUpdate) {
  constexpr fuzz::ScenarioBounds kSmall = {.min_points = 5, .max_points = 200, .max_steps = 20};
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    const fuzz::Scenario scenario = fuzz::random_scenario(seed, kSmall, {});
    fuzz::Random random(seed);
    EngineConfig config = scenario.config;
    config.min_points = std::floor(random.log_uniform(2.0, 100.0));
    fuzz::ChangingCloud map(scenario);
    use(config, map.cloud());
    for (const fuzz::Step& step : scenario.steps) {
      update(map.apply(step));
      expect_literal(map.live());
      if (HasFatalFailure()) FAIL() << "seed " << seed;
    }
  }
}

// Slices come in the order of their ids or in reverse order: equal weights are ordered by PointIds,
// not by PointIndices.
TEST_P(FragmentLayerIn, DecidesEqualWeightsByPointId) {
  // Four segments of two points; a single point in the middle of each two has edges of one weight.
  const std::vector<CloudPoint> points_W =
      fuzz::chain_of_weights(std::vector{1e-6, 4e-3, 4e-3, 1e-6, 4e-3, 4e-3, 1e-6});
  std::vector<std::vector<PointIndex>> partitions;
  for (const bool is_reversed : {false, true}) {
    PointCloud cloud;
    use({.min_points = 2}, cloud);
    for (int k = 0; k < std::ssize(points_W); ++k) {
      const int slice = is_reversed ? static_cast<int>(points_W.size()) - 1 - k : k;
      cloud.add_slice(slice, std::span(points_W).subspan(static_cast<std::size_t>(slice), 1));
      update(cloud.take_change());
    }
    std::vector<ComponentId> by_slice;
    for (int slice = 0; slice < std::ssize(points_W); ++slice) {
      by_slice.push_back(engine_->components()[cloud.find_slice(slice)->first]);
    }
    partitions.push_back(canonical_labels(by_slice));
  }
  EXPECT_EQ(partitions[0], partitions[1]);
  EXPECT_EQ(partitions[0], (std::vector<PointIndex>{0, 0, 0, 3, 3, 3, 6, 6}));
}

INSTANTIATE_TEST_SUITE_P(Modes, FragmentLayerIn,
                         ::testing::Values(LayerCase{"exact", NeighbourSearch::kGrid, 1e9},
                                           LayerCase{"exact", NeighbourSearch::kFlann, 1e9},
                                           LayerCase{"exact", NeighbourSearch::kGrid, 0.0},
                                           LayerCase{"exact", NeighbourSearch::kGrid, 0.4},
                                           LayerCase{"voting", NeighbourSearch::kGrid, 1e9}),
                         [](const auto& test) {
                           return std::string(test.param.mode) + "Number" +
                                  std::to_string(test.index);
                         });

}  // namespace
}  // namespace kintsugi::segmenter

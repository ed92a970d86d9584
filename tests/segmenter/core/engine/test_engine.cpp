#include <limits>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/engine/engine.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(MakeEngine, KnowsItsModes) {
  const PointCloud cloud;
  for (const std::string_view mode : engine_modes()) {
    EXPECT_NE(make_engine(mode, cloud, {}), nullptr);
  }
}

TEST(MakeEngine, EveryModeTellsItsMemory) {
  PointCloud cloud;
  cloud.add_slice(0, std::vector<CloudPoint>(3, CloudPoint{.nz = 1.0F}));
  const CloudChange change = cloud.take_change();
  for (const std::string_view mode : engine_modes()) {
    for (const NeighbourSearch search : {NeighbourSearch::kGrid, NeighbourSearch::kFlann}) {
      const auto engine = make_engine(mode, cloud, {.neighbour_search = search});
      engine->update(change);
      EXPECT_GT(engine->bytes(), 0U);
    }
  }
}

TEST(MakeEngine, NamesTheModesThereAre) {
  const PointCloud cloud;
  EXPECT_THAT([&] { make_engine("spectral", cloud, {}); },
              ThrowsMessage<std::invalid_argument>(
                  AllOf(HasSubstr("spectral"), HasSubstr("batch"), HasSubstr("voting"))));
}

TEST(EngineConfig, DefaultsAreThePapers) {
  const EngineConfig config;
  config.validate();
  EXPECT_EQ(config.threshold, 0.001);
  EXPECT_EQ(config.scale, 0.0005);
  EXPECT_EQ(config.beta, 0.85);
  EXPECT_EQ(config.radius_m(), 0.02F);
}

TEST(EngineConfig, NamesFieldValueAndBound) {
  const auto refused = [](EngineConfig config) { return [config] { config.validate(); }; };
  EXPECT_THAT(refused({.threshold = -0.5}),
              ThrowsMessage<std::invalid_argument>(
                  AllOf(HasSubstr("threshold"), HasSubstr("-0.5"), HasSubstr("> 0"))));
  EXPECT_THAT(refused({.scale = 0.0}), ThrowsMessage<std::invalid_argument>(HasSubstr("scale")));
  EXPECT_THAT(refused({.beta = 1.0}), ThrowsMessage<std::invalid_argument>(HasSubstr("beta")));
  EXPECT_THAT(refused({.beta = 0.0}), ThrowsMessage<std::invalid_argument>(HasSubstr("beta")));
  EXPECT_THAT(refused({.resolution_m = std::numeric_limits<double>::quiet_NaN()}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("resolution_m")));
  EXPECT_THAT(refused({.resolution_m = 1e-30}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("resolution_m")));
  EXPECT_THAT(refused({.radius_factor = std::numeric_limits<double>::infinity()}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("radius_factor")));
}

TEST(CanonicalLabels, NameEachComponentByItsSmallestPoint) {
  const std::vector<PointIndex> components = {2, 4, 2, 3, 4, 3};
  EXPECT_THAT(canonical_labels(components), ::testing::ElementsAre(0, 1, 0, 3, 1, 3));
}

}  // namespace
}  // namespace kintsugi::segmenter

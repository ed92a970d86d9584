#include <cstddef>
#include <stdexcept>
#include <string_view>

#include <gmock/gmock.h>

#include "segmenter/core/exact/vertex.hpp"
#include "segmenter/core/make_engine.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

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

/// What an engine holds for each point at least.
std::size_t least_bytes_per_point(std::string_view mode) {
  constexpr std::size_t kForestNode = sizeof(double) + 2 * sizeof(PointIndex);
  constexpr std::size_t kPosition = 3 * sizeof(float);  // in the neighbour index
  if (mode == "batch") return kForestNode + 2 * sizeof(ComponentId);
  if (mode == "voting") return kForestNode + kPosition + 8 * sizeof(PointIndex);
  return sizeof(exact::Vertex) + sizeof(exact::Absorption) + kPosition + sizeof(ComponentId);
}

TEST(MakeEngine, MemoryOfEveryModeIsTheSumOfWhatItHolds) {
  constexpr int kNumPoints = 120'000;
  PointCloud cloud;
  cloud.add_slice(0, testing::random_cloud(testing::CloudShape::kWaves, kNumPoints, 7));
  const CloudChange change = cloud.take_change();
  for (const std::string_view mode : engine_modes()) {
    for (const NeighbourSearch search : {NeighbourSearch::kGrid, NeighbourSearch::kFlann}) {
      const auto engine = make_engine(mode, cloud, {.neighbour_search = search});
      const std::size_t empty = engine->bytes();
      engine->update(change);
      EXPECT_GE(engine->bytes() - empty, kNumPoints * least_bytes_per_point(mode)) << mode;
    }
  }
}

TEST(MakeEngine, MemoryIncludesTheFragmentLayer) {
  constexpr int kNumPoints = 50'000;
  PointCloud cloud;
  cloud.add_slice(0, testing::random_cloud(testing::CloudShape::kWaves, kNumPoints, 7));
  const CloudChange change = cloud.take_change();
  for (const std::string_view mode : engine_modes()) {
    const auto without = make_engine(mode, cloud, {});
    const auto with = make_engine(mode, cloud, {.min_points = 20});
    without->update(change);
    with->update(change);
    EXPECT_GE(with->bytes(), without->bytes() + kNumPoints * sizeof(ComponentId)) << mode;
  }
}

TEST(MakeEngine, NamesTheModesThereAre) {
  const PointCloud cloud;
  EXPECT_THAT([&] { make_engine("spectral", cloud, {}); },
              ThrowsMessage<std::invalid_argument>(
                  AllOf(HasSubstr("spectral"), HasSubstr("batch"), HasSubstr("voting"))));
}

}  // namespace
}  // namespace kintsugi::segmenter

#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/engine/engine.hpp"

namespace kintsugi::segmenter {
namespace {

TEST(CanonicalLabels, NameEachComponentByItsSmallestPoint) {
  const std::vector<PointIndex> components = {2, 4, 2, 3, 4, 3};
  EXPECT_THAT(canonical_labels(components), ::testing::ElementsAre(0, 1, 0, 3, 1, 3));
}

}  // namespace
}  // namespace kintsugi::segmenter

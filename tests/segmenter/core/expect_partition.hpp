#pragma once

#include <vector>

#include <gtest/gtest.h>

#include "segmenter/core/engine/engine.hpp"
#include "tests/segmenter/core/literal_segmentation.hpp"

namespace kintsugi::segmenter::testing {

/// The same segments, named by their smallest points, and every theta to the bit.
inline void expect_partition(const SegmentationEngine& engine, const LiteralPartition& expected) {
  std::vector<PointIndex> labels(expected.of.size());
  std::vector<double> thetas(expected.of.size());
  for (const auto& [point, segment] : expected.of) {
    labels[point] = static_cast<PointIndex>(*segment->d.begin());
    thetas[point] = segment->theta;
  }
  EXPECT_EQ(canonical_labels(engine.components()), labels);
  std::vector<double> engine_thetas;
  for (const PointIndex representative : engine.components()) {
    ASSERT_EQ(engine.components()[representative], representative);
    engine_thetas.push_back(engine.theta(representative));
  }
  EXPECT_EQ(engine_thetas, thetas);
}

}  // namespace kintsugi::segmenter::testing

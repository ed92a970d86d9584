#pragma once

#include <span>
#include <vector>

#include "segmenter/core/engine.hpp"

namespace kintsugi::segmenter::fuzz {

/// A partition of n points 0 .. n - 1: for each the smallest point of its component, and theta of
/// its component.
struct Partition {
  std::vector<PointIndex> labels;
  std::vector<double> thetas;
};

/// By Algorithm 1 over `points_W` and nothing else.
Partition batch_partition(std::span<const CloudPoint> points_W, const EngineConfig& config);

/// What the engine says of the points `live`, the k-th of which is point k of the partition.
Partition partition_of(const SegmentationEngine& engine, std::span<const PointIndex> live);

}  // namespace kintsugi::segmenter::fuzz

#pragma once

#include <span>
#include <vector>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter::fuzz {

/// A partition of n points 0 .. n - 1: for each the smallest point of its component, and theta of
/// its component.
struct Partition {
  std::vector<PointIndex> labels;
  std::vector<double> thetas;
};

/// Algorithm 1 over `points_W`, without the fragment step.
Partition batch_partition(std::span<const CloudPoint> points_W, const EngineConfig& config);

/// By mode batch over the points of `cloud`, before fragments are joined and after. The k-th of the
/// points `live`, which are those in the cloud, is point k of the partitions.
struct BatchPartitions {
  Partition unmerged;
  Partition joined;
};
BatchPartitions batch_partitions(const PointCloud& cloud, std::span<const PointIndex> live,
                                 const EngineConfig& config);

/// One of the partitions of an engine, restricted to the points `live`.
Partition partition_of(const SegmentationEngine& engine, std::span<const ComponentId> components,
                       std::span<const PointIndex> live);

}  // namespace kintsugi::segmenter::fuzz

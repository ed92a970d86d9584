#pragma once

#include <cstdint>
#include <span>

#include "segmenter/core/batch/felzenszwalb.hpp"
#include "segmenter/core/batch/segment_forest.hpp"
#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {

/// What a batch segmentation did.
struct BatchStatistics {
  std::int64_t num_edges = 0;  ///< kept to be looked at
  std::int64_t num_joins = 0;
};

/// Algorithms 1 and 2 for all of `points` at once: joins them in `forest`, where each must be alone
/// in its segment. Edges of max_weight() and more cannot join anything, since no threshold theta
/// exceeds it, and are neither kept nor told.
///
/// After Osipov, Sanders and Singler, "The Filter-Kruskal Minimum Spanning Tree Algorithm" (2009):
/// the lightest third of the edges, which is enough for nearly all joins, is found and joined
/// first; then of the others only those between two of the segments so far. The result, and what
/// `observer` is told, are those of all edges in ascending order, for any number of threads.
BatchStatistics segment_points(const PointCloud& cloud, std::span<const PointIndex> points,
                               const EngineConfig& config, SegmentForest& forest,
                               JoinObserver& observer);

}  // namespace kintsugi::segmenter

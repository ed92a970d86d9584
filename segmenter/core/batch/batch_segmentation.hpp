#pragma once

#include <cstdint>
#include <span>

#include "segmenter/core/batch/felzenszwalb.hpp"
#include "segmenter/core/batch/segment_forest.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "segmenter/core/points/point_cloud.hpp"
#include "segmenter/core/points/point_rows.hpp"

namespace kintsugi::segmenter {

/// What a batch segmentation did.
struct BatchStatistics {
  std::int64_t num_edges = 0;  ///< found and kept
  std::int64_t num_joins = 0;
};

/// Algorithms 1 and 2 over all of `points`: joins them in `forest`, where each must be a segment of
/// its own. Edges of max_weight() and more, which never join anything, are neither kept nor
/// reported to `observer`.
///
/// After Osipov, Sanders and Singler, "The Filter-Kruskal Minimum Spanning Tree Algorithm" (2009).
/// The lightest third of the edges, which makes nearly all joins, is found and joined first. Of the
/// others only those between two different segments are then kept. The result, and the calls of
/// `observer`, are those of all edges in ascending order, for any number of threads.
BatchStatistics segment_points(const PointCloud& cloud, std::span<const PointIndex> points,
                               const EngineConfig& config, SegmentForest& forest,
                               JoinObserver& observer);
/// The same for the points of `rows`, which were made for config.radius_m().
BatchStatistics segment_points(const PointRows& rows, const EngineConfig& config,
                               SegmentForest& forest, JoinObserver& observer);

}  // namespace kintsugi::segmenter

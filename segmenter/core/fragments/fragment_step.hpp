#pragma once

#include <span>

#include "segmenter/core/fragments/fragment_forest.hpp"
#include "segmenter/core/graph/edge.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {

/// Is told of the joins, in order.
class FragmentObserver {
 public:
  virtual ~FragmentObserver() = default;
  /// Just before the sets of `root_i` and `root_j`, those of the points of the edge, are joined;
  /// `first_point` is its first one by PointId.
  virtual void joining(const Edge& /*edge*/, ComponentId /*root_i*/, ComponentId /*root_j*/,
                       PointIndex /*first_point*/) {}
};

/// The last step of Felzenszwalb and Huttenlocher's segmentation ("Efficient Graph-Based Image
/// Segmentation", 2004), all at once: of all edges between neighbours, however heavy, in ascending
/// order (EdgeOrder), each joins its two components if one of them is small.
///
/// `points` are those in the cloud, and `components` the partition `forest` was made for. Edges
/// inside a component, or between two that are not small, are not looked at: they join nothing.
/// The result is the same for any number of threads.
void join_fragments(const PointCloud& cloud, std::span<const PointIndex> points,
                    std::span<const ComponentId> components, const EngineConfig& config,
                    FragmentForest& forest, FragmentObserver& observer);

}  // namespace kintsugi::segmenter

#pragma once

#include <span>

#include "segmenter/core/fragments/fragment_forest.hpp"
#include "segmenter/core/graph/edge.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "segmenter/core/points/point_cloud.hpp"
#include "segmenter/core/points/point_rows.hpp"

namespace kintsugi::segmenter {

/// Called for each join, in order.
class FragmentObserver {
 public:
  virtual ~FragmentObserver() = default;
  /// Called just before the sets of the two points of the edge, with these roots, are joined.
  /// `first_point` is the one with the smaller PointId.
  virtual void joining(const Edge& /*edge*/, ComponentId /*root_i*/, ComponentId /*root_j*/,
                       PointIndex /*first_point*/) {}
};

/// The fragment step: the last step of Felzenszwalb and Huttenlocher's segmentation ("Efficient
/// Graph-Based Image Segmentation", 2004), over the whole cloud. It takes all edges between
/// neighbours, however heavy, in order (EdgeOrder); each joins the two sets of its points if they
/// are different and one of them is small.
///
/// `points` are those in the cloud, `components` is the partition that `forest` was made for. The
/// result is the same for any number of threads.
void join_fragments(const PointCloud& cloud, std::span<const PointIndex> points,
                    std::span<const ComponentId> components, const EngineConfig& config,
                    FragmentForest& forest, FragmentObserver& observer);
/// The same for the points of `rows`, which were made for config.radius_m().
void join_fragments(const PointCloud& cloud, const PointRows& rows,
                    std::span<const ComponentId> components, const EngineConfig& config,
                    FragmentForest& forest, FragmentObserver& observer);

}  // namespace kintsugi::segmenter

#pragma once

#include <cstdint>
#include <span>
#include <utility>

#include "segmenter/core/graph/edge.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {

/// The order in which the fragment step takes edges: by ascending weight, equal weights by the
/// PointIds of the two points, the smaller one first. The result of this step does depend on the
/// order of equal weights. So they must be ordered by PointIds, which persist, and not by
/// PointIndices as in AscendingWeight, which depend on the order in which points came.
class EdgeOrder {
 public:
  explicit EdgeOrder(const PointCloud& cloud) : cloud_(cloud) {}

  bool operator()(const Edge& a, const Edge& b) const {
    return a.weight != b.weight ? a.weight < b.weight : ids_of(a) < ids_of(b);
  }
  /// Of the two points of an edge the one with the smaller PointId.
  PointIndex first_point(const Edge& edge) const {
    return cloud_.id_of(edge.i) < cloud_.id_of(edge.j) ? edge.i : edge.j;
  }
  void sort(std::span<Edge> edges) const;

 private:
  using Ids = std::pair<PointId, PointId>;

  Ids ids_of(const Edge& edge) const {
    const Ids ids(cloud_.id_of(edge.i), cloud_.id_of(edge.j));
    return ids.first < ids.second ? ids : Ids(ids.second, ids.first);
  }
  void sort_ties(std::span<Edge> edges) const;

  const PointCloud& cloud_;
};

}  // namespace kintsugi::segmenter

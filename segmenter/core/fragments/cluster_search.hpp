#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/base/growing_array.hpp"
#include "segmenter/core/fragments/base_components.hpp"
#include "segmenter/core/fragments/clusters.hpp"
#include "segmenter/core/fragments/edge_order.hpp"
#include "segmenter/core/fragments/neighbour_cursor.hpp"
#include "segmenter/core/graph/edge_weight.hpp"

namespace kintsugi::segmenter {

/// Finds the cluster of a fragment (see FragmentLayer) as Prim's algorithm finds a minimum spanning
/// tree: adds the component at the other end of the first edge that leads out, until the limit
/// would be reached. Costs one neighbour search for each point of the cluster.
class ClusterSearch {
 public:
  struct Found {
    std::span<const PointIndex> points;  ///< valid until the next search
    Exit exit;
  };

  ClusterSearch(const PointCloud& cloud, const NeighbourIndex& index,
                const BaseComponents& components, const EdgeWeight& weight_of)
      : cloud_(cloud),
        index_(index),
        components_(components),
        weight_of_(weight_of),
        order_(cloud) {}

  void grow(PointIndex num_points) { seen_.resize(num_points); }

  /// The cluster of the fragment that has the point `from`.
  Found operator()(PointIndex from);

  void swap_to(SwapSpace& space) { seen_.swap_to(space); }
  std::size_t bytes() const { return seen_.bytes(); }

 private:
  void begin();
  void add_component_of(PointIndex point);
  void look_at(const Edge& edge);
  Edge take_first_edge();
  void see(PointIndex point) {
    seen_[point] = search_;
    points_.push_back(point);
  }
  bool is_seen(PointIndex point) const { return seen_[point] == search_; }

  const PointCloud& cloud_;
  const NeighbourIndex& index_;
  const BaseComponents& components_;
  EdgeWeight weight_of_;
  EdgeOrder order_;
  std::uint32_t search_ = 0;          ///< number of the current search
  GrowingArray<std::uint32_t> seen_;  ///< by point: number of the last search that reached it
  std::vector<PointIndex> points_;    ///< reached, component after component
  std::vector<Edge> edges_;           ///< heap of edges that lead out, from i to j
  Edge first_to_large_;               ///< first edge to a large component: the search ends there
};

}  // namespace kintsugi::segmenter

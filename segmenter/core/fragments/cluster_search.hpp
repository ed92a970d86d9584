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

namespace kintsugi::segmenter {

/// Finds the cluster of a fragment as Prim's algorithm finds a minimum spanning tree: takes the
/// first of the edges that lead out, and the whole component at its other end, until there are as
/// many points as the limit. Costs as many neighbour searches as there are points below the limit.
class ClusterSearch {
 public:
  struct Found {
    std::span<const PointIndex> points;  ///< until the next search
    Exit exit;
  };

  ClusterSearch(const PointCloud& cloud, const NeighbourIndex& index,
                const BaseComponents& components, double color_weight)
      : cloud_(cloud),
        index_(index),
        components_(components),
        color_weight_(color_weight),
        order_(cloud) {}

  void grow(PointIndex num_points) { seen_.resize(num_points); }

  /// `from` is a point of a fragment.
  Found operator()(PointIndex from);

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
  double color_weight_;
  EdgeOrder order_;
  std::uint32_t search_ = 0;          ///< number of this search
  GrowingArray<std::uint32_t> seen_;  ///< by which search a point was seen last
  std::vector<PointIndex> points_;    ///< seen, component after component
  std::vector<Edge> edges_;           ///< heap of those that lead out, from i to j
  Edge first_to_large_;               ///< none after this one is ever taken
};

}  // namespace kintsugi::segmenter

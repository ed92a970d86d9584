#pragma once

#include "segmenter/core/exact/join_forest.hpp"
#include "segmenter/core/exact/tree_edges.hpp"
#include "segmenter/core/exact/vertex.hpp"
#include "segmenter/core/exact/watch_heaps.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter::exact {

/// The state of the exact engine between two updates; exact_engine.hpp explains its parts.
struct State {
  explicit State(const JoinRule& rule)
      : edges(vertices), forest(vertices, edges, rule), watches(vertices) {}
  State(const State&) = delete;  // the parts refer to the vertices
  State& operator=(const State&) = delete;

  /// Clears everything except which points are gone.
  void clear();

  void swap_to(SwapSpace& space) {
    vertices.swap_to(space);
    edges.swap_to(space);
    watches.swap_to(space);
  }
  std::size_t bytes() const { return vertices.bytes() + edges.bytes() + watches.bytes(); }

  Vertices vertices;
  TreeEdges edges;
  JoinForest forest;
  WatchHeaps watches;
};

/// Computes the edges of points from the cloud and its neighbour index.
class EdgeFinder {
 public:
  /// Leaves out edges of max_weight() and more, which never join anything.
  EdgeFinder(const PointCloud& cloud, const NeighbourIndex& index, const EngineConfig& config)
      : cloud_(cloud),
        index_(index),
        weight_of_(config.edge_weight()),
        max_weight_(config.max_weight()) {}

  /// Calls fn(other, key) for each edge of the points in `points`, point after point.
  template <typename Fn>
  void for_each(std::span<const PointIndex> points, Fn&& fn) const {
    index_.visit(points, [&](PointIndex i, std::span<const PointIndex> neighbours) {
      for (const PointIndex j : neighbours) {
        const float weight = weight_of_(cloud_[i], cloud_[j]);
        if (weight < max_weight_) fn(i, j, EdgeKey::of(weight, i, j));
      }
    });
  }

 private:
  const PointCloud& cloud_;
  const NeighbourIndex& index_;
  EdgeWeight weight_of_;
  double max_weight_;
};

}  // namespace kintsugi::segmenter::exact

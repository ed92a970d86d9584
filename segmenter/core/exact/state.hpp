#pragma once

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/exact/join_forest.hpp"
#include "segmenter/core/exact/tree_edges.hpp"
#include "segmenter/core/exact/vertex.hpp"
#include "segmenter/core/exact/watch_heaps.hpp"
#include "segmenter/core/graph/edge_weight.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"

namespace kintsugi::segmenter::exact {

/// What the exact engine remembers between two runs.
struct State {
  explicit State(const JoinRule& rule)
      : edges(vertices), forest(vertices, edges, rule), watches(vertices) {}
  State(const State&) = delete;  // the parts refer to the vertices
  State& operator=(const State&) = delete;

  /// Forgets everything but who is gone.
  void clear();

  std::size_t bytes() const { return vertices.bytes() + edges.bytes() + watches.bytes(); }

  Vertices vertices;
  TreeEdges edges;
  JoinForest forest;
  WatchHeaps watches;
};

/// The edges of a point that are not remembered, from the cloud and its neighbour index.
class EdgeFinder {
 public:
  /// Edges of max_weight() and more never join anything and are left out.
  EdgeFinder(const PointCloud& cloud, const NeighbourIndex& index, const EngineConfig& config)
      : cloud_(cloud),
        index_(index),
        color_weight_(config.color_weight),
        max_weight_(config.max_weight()) {}

  /// Calls fn(other, key) for each edge of the points in `points`, point after point.
  template <typename Fn>
  void for_each(std::span<const PointIndex> points, Fn&& fn) const {
    index_.visit(points, [&](PointIndex i, std::span<const PointIndex> neighbours) {
      for (const PointIndex j : neighbours) {
        const float weight = edge_weight(cloud_[i], cloud_[j], color_weight_);
        if (weight < max_weight_) fn(i, j, EdgeKey::of(weight, i, j));
      }
    });
  }

 private:
  const PointCloud& cloud_;
  const NeighbourIndex& index_;
  double color_weight_;
  double max_weight_;
};

}  // namespace kintsugi::segmenter::exact

#pragma once

#include <cassert>
#include <cstdint>
#include <vector>

#include "segmenter/core/exact/edge_key.hpp"
#include "segmenter/core/exact/vertex.hpp"

namespace kintsugi::segmenter::exact {

/// The edges that joined two components. Those that did so before the current run, the old tree,
/// are linked: each vertex has a list of its edges in the old tree. Ids of released edges are used
/// again.
class TreeEdges {
 public:
  explicit TreeEdges(Vertices& vertices) : vertices_(vertices) {}

  /// Adds an edge that is not in the old tree and has no owner.
  TreeEdgeId add(const EdgeKey& key) {
    TreeEdgeId id = first_free_;
    if (id != kNone) {
      first_free_ = edges_[id].next[0];
    } else {
      id = static_cast<TreeEdgeId>(edges_.size());
      edges_.resize(edges_.size() + 1);
    }
    edges_[id] = {key, kNone, {kUnlinked, kUnlinked}};
    return id;
  }

  /// The edge must not be in the old tree.
  void release(TreeEdgeId id) {
    assert(!is_linked(id));
    edges_[id].next[0] = first_free_;
    first_free_ = id;
  }

  const EdgeKey& key(TreeEdgeId id) const { return edges_[id].key; }
  /// The guest of the join that this edge makes; kNone: it makes none at present.
  PointIndex owner(TreeEdgeId id) const { return edges_[id].owner; }
  void set_owner(TreeEdgeId id, PointIndex owner) { edges_[id].owner = owner; }

  /// Whether the edge is in the old tree.
  bool is_linked(TreeEdgeId id) const { return edges_[id].next[0] != kUnlinked; }
  void link(TreeEdgeId id) {
    for (std::uint32_t side = 0; side < 2; ++side) {
      Vertex& v = vertices_[end(id, side)];
      edges_[id].next[side] = v.half_edges;
      v.half_edges = 2 * id + side;
    }
  }
  void unlink(TreeEdgeId id) {
    for (std::uint32_t side = 0; side < 2; ++side) {
      std::uint32_t* half = &vertices_[end(id, side)].half_edges;
      while (*half != 2 * id + side) half = &edges_[*half >> 1].next[*half & 1];
      *half = edges_[id].next[side];
    }
    edges_[id].next[0] = edges_[id].next[1] = kUnlinked;
  }

  /// Calls fn(id, other end) for the edges of the old tree at `v`.
  template <typename Fn>
  void for_each_linked(PointIndex v, Fn&& fn) const {
    for (std::uint32_t half = vertices_[v].half_edges; half != kNone;
         half = edges_[half >> 1].next[half & 1]) {
      fn(half >> 1, end(half >> 1, 1 - (half & 1)));
    }
  }

  void swap_to(SwapSpace& space) { edges_.swap_to(space); }
  std::size_t bytes() const { return edges_.bytes(); }

  /// Removes all edges. The lists at the vertices are left as they are.
  void clear() {
    edges_.clear();
    first_free_ = kNone;
  }

 private:
  static constexpr std::uint32_t kUnlinked = kNone - 1;  // kNone ends a list

  struct TreeEdge {
    EdgeKey key;
    PointIndex owner;
    std::uint32_t next[2];  // by end: next half edge in its list; half edge = 2 * id + (1 at end b)
  };

  PointIndex end(TreeEdgeId id, std::uint32_t side) const {
    return side == 0 ? edges_[id].key.a : edges_[id].key.b;
  }

  Vertices& vertices_;
  GrowingArray<TreeEdge> edges_;
  TreeEdgeId first_free_ = kNone;
};

}  // namespace kintsugi::segmenter::exact

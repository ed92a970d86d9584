#pragma once

#include <vector>

#include "segmenter/core/exact/join_history.hpp"
#include "segmenter/core/exact/tree_edges.hpp"
#include "segmenter/core/exact/vertex.hpp"

namespace kintsugi::segmenter::exact {

/// A union-find that remembers when each join was made (partially persistent: it can be asked
/// about any time, and the future of a component can be taken back).
///
/// A vertex stands for a component as its representative, until it is absorbed by `host` at the
/// key of the tree edge `edge`. Roots never are. Along the hosts keys ascend, so the component of x
/// at a time is found by climbing while the keys are smaller.
class JoinForest {
 public:
  JoinForest(Vertices& vertices, TreeEdges& edges, const JoinRule& rule)
      : vertices_(vertices), edges_(edges), rule_(rule), history_(vertices, edges, rule) {}

  const JoinHistory& history() const { return history_; }

  /// The representative of x just before `time`.
  PointIndex representative_before(PointIndex x, const EdgeKey& time) const {
    while (is_absorbed_before(x, time)) x = vertices_.host(x);
    return x;
  }
  /// The representative of x just after `time`.
  PointIndex representative_after(PointIndex x, const EdgeKey& time) const {
    while (is_absorbed_up_to(x, time)) x = vertices_.host(x);
    return x;
  }
  PointIndex root(PointIndex x) const {
    while (!vertices_.is_root(x)) x = vertices_.host(x);
    return x;
  }

  /// When x is, or was, absorbed; kNever for a root.
  EdgeKey key(PointIndex x) const {
    return vertices_[x].edge == kNone ? kNever : edges_.key(vertices_[x].edge);
  }
  bool is_absorbed_before(PointIndex x, const EdgeKey& time) const {
    const std::uint32_t weight_bits = vertices_.absorption(x).weight_bits;
    if (weight_bits != time.weight_bits) return weight_bits < time.weight_bits;
    return !vertices_.is_root(x) && edges_.key(vertices_[x].edge) < time;
  }
  bool is_absorbed_up_to(PointIndex x, const EdgeKey& time) const {
    const std::uint32_t weight_bits = vertices_.absorption(x).weight_bits;
    if (weight_bits != time.weight_bits) return weight_bits < time.weight_bits;
    return !vertices_.is_root(x) && !(time < edges_.key(vertices_[x].edge));
  }

  /// Whether the component that x stands for just before `time` is alive: the weight is below its
  /// theta.
  bool is_alive(PointIndex x, const EdgeKey& time) const {
    const JoinHistory::State state = history_.state_before(x, time);
    return static_cast<double>(time.weight()) < rule_.theta(state.weight, state.size);
  }

  /// `guest`, a root, is absorbed by `host` through `edge`, with all the points it has.
  void absorb(PointIndex host, PointIndex guest, TreeEdgeId edge);
  /// Frees `guest`: a root again. Returns the host it had.
  PointIndex release(PointIndex guest);
  /// Frees all children that `host` absorbs after `time`; appends them to `freed`, with the edges
  /// that held them, in order.
  struct Freed {
    PointIndex guest;
    TreeEdgeId edge;
  };
  void release_after(PointIndex host, const EdgeKey& time, std::vector<Freed>& freed);
  /// Counts `guest` in its host with the points it has now; false when that is no change.
  bool recount(PointIndex guest);
  /// Makes x, which is gone, host of nobody who stays: the first of its children that is not gone
  /// takes over its later history and its place, and x becomes a guest of it, with the children it
  /// had before. Returns that child; kNone when all are gone. The components at any time stay what
  /// they are, but for their representatives.
  PointIndex step_down(PointIndex x);

  /// For the bulk construction: `children` of `host`, whose host, edge and size are set.
  void build_history(PointIndex host, std::span<const PointIndex> children) {
    history_.build(host, children);
  }

 private:
  void set_free(PointIndex guest);

  Vertices& vertices_;
  TreeEdges& edges_;
  JoinRule rule_;
  JoinHistory history_;
};

}  // namespace kintsugi::segmenter::exact

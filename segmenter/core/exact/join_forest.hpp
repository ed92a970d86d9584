#pragma once

#include <vector>

#include "segmenter/core/exact/join_history.hpp"
#include "segmenter/core/exact/tree_edges.hpp"
#include "segmenter/core/exact/vertex.hpp"

namespace kintsugi::segmenter::exact {

/// A union-find that remembers when each join was made (partially persistent): it can be asked
/// about any time, and joins after a time can be taken back.
///
/// A vertex represents a component until it is absorbed by its host, at the key of its tree edge.
/// A root is never absorbed. Keys ascend along the hosts, so the component of x at a time is found
/// by climbing as long as the keys are smaller.
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

  /// The time at which x is absorbed; kNever for a root.
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

  /// Whether the component that x represents just before `time` is alive at that edge.
  bool is_alive(PointIndex x, const EdgeKey& time) const {
    const JoinHistory::State state = history_.state_before(x, time);
    return static_cast<double>(time.weight()) < rule_.theta(state.weight, state.size);
  }

  /// Makes `guest`, a root, a guest of `host` at the time of `edge`, with all the points it has.
  void absorb(PointIndex host, PointIndex guest, TreeEdgeId edge);
  /// Makes `guest` a root again. Returns the host it had.
  PointIndex release(PointIndex guest);
  /// Makes all guests that `host` absorbs after `time` roots again. Appends them to `freed`, with
  /// their tree edges, by time.
  struct Freed {
    PointIndex guest;
    TreeEdgeId edge;
  };
  void release_after(PointIndex host, const EdgeKey& time, std::vector<Freed>& freed);
  /// Updates the size that `guest` has in its host; false when it is the same.
  bool recount(PointIndex guest);
  /// Replaces x, a removed point, as a host of points that stay. The first of its guests that is
  /// not removed takes its place: it becomes the host of x at the time of its own absorption, gets
  /// the later guests of x, and is absorbed by the host of x. The components stay the same at every
  /// time; only their representatives change.
  /// @return that guest; kNone when all guests are removed, and nothing was done
  PointIndex step_down(PointIndex x);

  /// For the bulk construction: builds the history of `host` from its guests in order, whose host,
  /// edge and size are set.
  void build_history(PointIndex host, std::span<const PointIndex> guests) {
    history_.build(host, guests);
  }

 private:
  void set_free(PointIndex guest);

  Vertices& vertices_;
  TreeEdges& edges_;
  JoinRule rule_;
  JoinHistory history_;
};

}  // namespace kintsugi::segmenter::exact

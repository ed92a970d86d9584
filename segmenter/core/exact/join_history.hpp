#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "segmenter/core/exact/join_rule.hpp"
#include "segmenter/core/exact/tree_edges.hpp"
#include "segmenter/core/exact/vertex.hpp"

namespace kintsugi::segmenter::exact {

/// The joins that each host made, in order.
///
/// The history of a host holds the children it absorbed, ordered by the key of their tree edge, in
/// a balanced tree (a treap whose priorities are hashed from the vertices). Each child carries a
/// capacity: the most points that the host may have gained, up to and including this join, and
/// still be alive at what it does next (its next join, or its own absorption). The least slack,
/// capacity minus points gained, is kept over each subtree. So the first join that a change of
/// size breaks is found in O(log n), and the history of a floor of a million points, a spine of
/// 100,000 joins, never is replayed.
class JoinHistory {
 public:
  JoinHistory(Vertices& vertices, const TreeEdges& edges, const JoinRule& rule)
      : vertices_(vertices), edges_(edges), rule_(rule) {}

  /// Puts `child` (host, edge and size are set) into the history of its host.
  void insert(PointIndex child);
  /// Takes it out again. Its host, edge and size stay.
  void erase(PointIndex child);
  /// Takes out all children of `host` that joined after `time`; appends them to `out`, in order.
  void split_after(PointIndex host, const EdgeKey& time, std::vector<PointIndex>& out);
  /// Makes `children`, in order, the history of `host`, which has none; in linear time.
  void build(PointIndex host, std::span<const PointIndex> children);
  /// Takes the children that joined `host` after `time` away from it, to be given to append().
  PointIndex take_after(PointIndex host, const EdgeKey& time);
  /// Appends what take_after() took from another host to the history of `host`; all of it is later.
  /// Takes time in proportion to its children: each gets to know its new host.
  void append(PointIndex host, PointIndex taken);

  /// Takes notice that the size of `child` is another now.
  void update_size(PointIndex child) { refresh_path(vertices_.host(child), child); }
  /// Takes notice that `host` itself was absorbed, or freed: its last child has another capacity.
  void update_end(PointIndex host);

  /// Points of the component that `host` stands for, with all that it ever absorbs.
  std::uint32_t total(PointIndex host) const {
    const PointIndex t = vertices_[host].history;
    return t == kNone ? 1 : 1 + vertices_[t].sum;
  }
  struct State {
    std::uint32_t size = 1;
    float weight = 0.0F;  ///< of the last join
  };
  /// The component of `host` just before `time`.
  State state_before(PointIndex host, const EdgeKey& time) const;
  /// theta of the component of `host` after its last join.
  double final_theta(PointIndex host) const;

  /// The earliest thing that `host` cannot do any more with the sizes as they are: the child that
  /// it could not join, or `host` itself for its own absorption; kNone when all is well.
  PointIndex first_broken(PointIndex host) const;

  /// The first child of `host` that is_wanted(child); kNone when there is none.
  template <typename IsWanted>
  PointIndex first_child_that(PointIndex host, IsWanted&& is_wanted) const {
    return first_that(vertices_[host].history, is_wanted);
  }
  /// Calls fn(child) for the children of `host`, in order.
  template <typename Fn>
  void for_each_child(PointIndex host, Fn&& fn) const {
    for_each_in_order(vertices_[host].history, fn);
  }

 private:
  template <typename IsWanted>
  PointIndex first_that(PointIndex t, IsWanted& is_wanted) const {
    while (t != kNone) {
      const PointIndex found = first_that(vertices_[t].left, is_wanted);
      if (found != kNone) return found;
      if (is_wanted(t)) return t;
      t = vertices_[t].right;
    }
    return kNone;
  }
  template <typename Fn>
  void for_each_in_order(PointIndex t, Fn&& fn) const {
    std::vector<PointIndex> path;
    while (t != kNone || !path.empty()) {
      for (; t != kNone; t = vertices_[t].left) path.push_back(t);
      const PointIndex child = path.back();
      path.pop_back();
      t = vertices_[child].right;
      fn(child);
    }
  }
  bool is_before(PointIndex x, PointIndex y) const;
  bool is_up_to(PointIndex x, const EdgeKey& time) const;
  void refresh(PointIndex t);
  void refresh_path(PointIndex host, PointIndex child);
  void set_capacity(PointIndex child, PointIndex next);
  PointIndex neighbour(PointIndex host, PointIndex child, bool before) const;
  PointIndex first(PointIndex host) const;
  PointIndex last(PointIndex host) const;
  void note_last(PointIndex host);
  PointIndex insert_below(PointIndex t, PointIndex child);
  PointIndex erase_below(PointIndex t, PointIndex child);
  PointIndex merge(PointIndex a, PointIndex b);
  struct Halves {
    PointIndex up_to;
    PointIndex after;
  };
  Halves split(PointIndex t, const EdgeKey& time);

  Vertices& vertices_;
  const TreeEdges& edges_;
  JoinRule rule_;
};

}  // namespace kintsugi::segmenter::exact

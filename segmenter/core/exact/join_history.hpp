#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "segmenter/core/exact/join_rule.hpp"
#include "segmenter/core/exact/tree_edges.hpp"
#include "segmenter/core/exact/vertex.hpp"

namespace kintsugi::segmenter::exact {

/// The joins that each host made, by time.
///
/// The history of a host holds its guests, ordered by the key of their tree edge, in a balanced
/// tree (a treap whose priorities are hashes of the vertices). Each guest has a capacity: the most
/// points that the host may have gained, up to and including this join, and still be alive at what
/// it does next (its next join, or its own absorption). Each subtree knows its least slack, which
/// is capacity minus points gained. So the first join that a change of size breaks is found in
/// O(log n), and the history of a floor of a million points, 100,000 joins, is never run again as a
/// whole.
class JoinHistory {
 public:
  JoinHistory(Vertices& vertices, const TreeEdges& edges, const JoinRule& rule)
      : vertices_(vertices), edges_(edges), rule_(rule) {}

  /// Inserts `guest`, whose host, edge and size are set, into the history of its host.
  void insert(PointIndex guest);
  /// Removes it again. Its host, edge and size stay.
  void erase(PointIndex guest);
  /// Removes all guests of `host` that joined after `time`; appends them to `out`, by time.
  void split_after(PointIndex host, const EdgeKey& time, std::vector<PointIndex>& out);
  /// Makes `guests`, given by time, the history of `host`, which has none; in linear time.
  void build(PointIndex host, std::span<const PointIndex> guests);
  /// Cuts off the guests that joined `host` after `time`, for append(). Returns their subtree.
  PointIndex take_after(PointIndex host, const EdgeKey& time);
  /// Appends what take_after() cut off from another host to the history of `host`, all of which is
  /// earlier. Takes time proportional to the guests, whose host has to be changed.
  void append(PointIndex host, PointIndex taken);

  /// To be called after the size of `guest` changed.
  void update_size(PointIndex guest) { refresh_path(vertices_.host(guest), guest); }
  /// To be called after `host` was absorbed or freed, which changes the capacity of its last guest.
  void update_end(PointIndex host);

  /// The points of the component that `host` represents after its last join.
  std::uint32_t total(PointIndex host) const {
    const PointIndex t = vertices_[host].history;
    return t == kNone ? 1 : 1 + vertices_[t].sum;
  }
  struct State {
    std::uint32_t size = 1;
    float weight = 0.0F;  ///< of the last join
  };
  /// The component that `host` represents just before `time`.
  State state_before(PointIndex host, const EdgeKey& time) const;
  /// theta of the component of `host` after its last join.
  double final_theta(PointIndex host) const;

  /// The first event in the history of `host` that the present sizes do not allow, because the host
  /// would be frozen: the guest of that join, or `host` itself for its own absorption. kNone when
  /// they allow all.
  PointIndex first_broken(PointIndex host) const;

  /// The first guest of `host` for which is_wanted(guest) holds; kNone when there is none.
  template <typename IsWanted>
  PointIndex first_guest_that(PointIndex host, IsWanted&& is_wanted) const {
    return first_that(vertices_[host].history, is_wanted);
  }
  /// Calls fn(guest) for the guests of `host`, by time.
  template <typename Fn>
  void for_each_guest(PointIndex host, Fn&& fn) const {
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
      const PointIndex guest = path.back();
      path.pop_back();
      t = vertices_[guest].right;
      fn(guest);
    }
  }
  // Nodes of the treaps are guests; t is the root of a subtree.
  bool is_before(PointIndex x, PointIndex y) const;
  bool is_up_to(PointIndex x, const EdgeKey& time) const;
  void refresh(PointIndex t);
  void refresh_path(PointIndex host, PointIndex guest);
  void set_capacity(PointIndex guest, PointIndex next);
  PointIndex neighbour(PointIndex host, PointIndex guest, bool before) const;
  PointIndex first(PointIndex host) const;
  PointIndex last(PointIndex host) const;
  void store_last_weight(PointIndex host);
  PointIndex insert_below(PointIndex t, PointIndex guest);
  PointIndex erase_below(PointIndex t, PointIndex guest);
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

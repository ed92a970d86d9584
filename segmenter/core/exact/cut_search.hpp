#pragma once

#include <cstdint>
#include <iterator>
#include <vector>

#include "segmenter/core/exact/join_forest.hpp"
#include "segmenter/core/exact/tree_edges.hpp"
#include "segmenter/core/exact/vertex.hpp"

namespace kintsugi::segmenter::exact {

/// Finds which points must be explored because an edge of the old tree does not join any more.
///
/// The old component P of a point at a time is the part of the old tree that edges up to then
/// connect. An edge inside P was skipped in the old run and is not stored. If P has fallen apart,
/// it may now join the pieces. Hence the invariant, which makes the engine exact: at every time,
/// and for every P, the points of P that are not explored are in one component now. An old edge
/// inside P therefore either lies inside a component again, or one of its ends is explored and the
/// edge is in the queue.
///
/// The invariant can break only where the old tree joins two old components P and Q. There
/// reconcile() restores it: if their unexplored points are in two components now, it explores those
/// of the smaller one of P and Q. This happens at the time of each old tree edge, not for the whole
/// old tree when the first edge is rejected. So it stops as soon as other edges connect the pieces
/// again, and it costs what P or Q have in points at that time, not what the segment has in the
/// end.
///
/// Explored points are grouped into families. A family knows its main point: an unexplored point of
/// the same old component.
class CutSearch {
 public:
  CutSearch(Vertices& vertices, const TreeEdges& edges, const JoinForest& forest)
      : vertices_(vertices), edges_(edges), forest_(forest) {}

  /// A removed point counts as explored, since it has no edges left.
  void set_gone(PointIndex x) { mark(x, new_family(kNone)); }

  /// To be called for each edge (u, v) of the old tree that is looked at, at its key `time`, after
  /// it was decided. Returns the points to explore: their edges after `time` must be queued, and
  /// the futures of the representatives among them taken back.
  const std::vector<PointIndex>& reconcile(PointIndex u, PointIndex v, const EdgeKey& time);

  /// Ends the run: no point is explored any more.
  void finish();

  bool is_explored(PointIndex x) const { return vertices_[x].family != 0; }
  std::int64_t num_explored() const { return std::ssize(explored_); }

 private:
  struct Family {
    std::uint32_t parent;  ///< union-find: the family that it was merged into, or itself
    PointIndex main;       ///< kNone: every point of the old component is explored
  };
  /// One of the two searches, breadth first over the old component of a point.
  struct Search {
    std::vector<PointIndex> points;
    std::size_t num_expanded = 0;
    std::size_t cost = 0;
  };

  std::uint32_t new_family(PointIndex main);
  std::uint32_t find_family(PointIndex x);
  void mark(PointIndex x, std::uint32_t family);
  PointIndex main_point(PointIndex x);
  void explore_smaller(PointIndex& main_u, PointIndex& main_v, const EdgeKey& time);
  Search& search_smaller(PointIndex from_u, PointIndex from_v, const EdgeKey& time);
  void expand(Search& search, const EdgeKey& time);
  void reach(Search& search, PointIndex x, const EdgeKey& time);

  Vertices& vertices_;
  const TreeEdges& edges_;
  const JoinForest& forest_;
  std::vector<Family> families_{1};  ///< by number; 0 means no family
  std::vector<PointIndex> explored_;
  Search sides_[2];
  std::vector<PointIndex> to_explore_;
};

}  // namespace kintsugi::segmenter::exact

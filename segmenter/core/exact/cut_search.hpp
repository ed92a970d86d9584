#pragma once

#include <cstdint>
#include <iterator>
#include <vector>

#include "segmenter/core/exact/join_forest.hpp"
#include "segmenter/core/exact/tree_edges.hpp"
#include "segmenter/core/exact/vertex.hpp"

namespace kintsugi::segmenter::exact {

/// Finds which points must look at their edges again because an edge of the old tree does not join
/// any more.
///
/// The old component P of a point at a time is what the old tree connects by edges up to then. An
/// edge inside P was skipped in the old state, and nobody remembers it; when P has fallen apart it
/// may join the pieces. Looking at the edges of a point anew is called exploring it. The invariant
/// that makes the engine exact: the points of P that are not explored are in one component now, at
/// every time and for every P. So an edge inside P that was skipped either is inside a component
/// again, or it has an end that is explored, and is in the queue.
///
/// The invariant can break only where the old tree joins two old components P and Q. reconcile()
/// restores it there: if their unexplored points are in two components, it explores the smaller
/// one of P and Q. As it is done when the time of each edge comes, and not for the whole of the old
/// tree when the first edge is rejected, it stops as soon as a replacement has been found; it costs
/// what the two components had in points then, not what the segment has in the end.
///
/// Explored points belong to families; each family knows a point of the same old component that is
/// not explored, its main point.
class CutSearch {
 public:
  CutSearch(Vertices& vertices, const TreeEdges& edges, const JoinForest& forest)
      : vertices_(vertices), edges_(edges), forest_(forest) {}

  /// A point that is gone counts as explored: it has no edges any more.
  void set_gone(PointIndex x) { mark(x, new_family(kNone)); }

  /// To be called just after `time`, the key of the old tree's edge (u, v), once it is known
  /// whether that joins. Returns the points to explore: their edges after `time` are to be queued,
  /// the later joins of representatives among them to be undone.
  const std::vector<PointIndex>& reconcile(PointIndex u, PointIndex v, const EdgeKey& time);

  /// Ends the run: forgets what was explored.
  void finish();

  bool is_explored(PointIndex x) const { return vertices_[x].family != 0; }
  std::int64_t num_explored() const { return std::ssize(explored_); }

 private:
  struct Family {
    std::uint32_t parent;  ///< itself: a family of its own
    PointIndex main;       ///< kNone: every point of the old component is explored
  };
  /// One of the two searches: the old component of a point, breadth first.
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
  std::vector<Family> families_{1};  ///< by number; 0 is none
  std::vector<PointIndex> explored_;
  Search sides_[2];
  std::vector<PointIndex> to_explore_;
};

}  // namespace kintsugi::segmenter::exact

#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "segmenter/core/engine/incremental_engine.hpp"
#include "segmenter/core/exact/change_propagation.hpp"
#include "segmenter/core/exact/component_names.hpp"
#include "segmenter/core/exact/edges_ahead.hpp"
#include "segmenter/core/exact/state.hpp"

namespace kintsugi::segmenter {

/// Mode `exact`: after each update the partition and every theta are those of `batch`, at a cost
/// that depends on the change and hardly on the size of the map.
///
/// Terms, used in all of exact/:
///
///   key, time      Algorithm 1 takes the edges in ascending order of their keys: weight, then the
///                  two points (EdgeKey). The key of an edge is the time at which it is decided.
///   theta          the join threshold of a component: T for a single point, w + k/size after a
///                  join at weight w (Eq. 3).
///   alive, frozen  a component is alive at an edge whose weight is below its theta, else frozen.
///                  An edge joins two different components if both are alive. Since weights
///                  ascend, a frozen component never becomes alive again.
///   host, guest    of two components that join. The guest is absorbed: its representative hangs
///                  below that of the host from then on.
///   representative the vertex (= point) that stands for a component at a given time.
///   join forest    the vertices with their hosts. A root represents a final component: a segment.
///   history        of a host: the guests that it absorbed, by time.
///   future         of a vertex at a time: the guests that it absorbs later, and its own absorption
///                  if that is later.
///   tree edge      an edge that joined two components. Those of a segment are a spanning tree;
///                  the old tree is the one from before the update.
///   watch heap     the edges that a segment blocked because it was frozen, lightest first.
///   explore        to look at all later edges of a point again, in the neighbour index.
///
/// The state between two updates (exact::State) is the history of the last run of Algorithm 1:
///
///   JoinForest     the host of each vertex and the time of its absorption; so the component of a
///                  point at any time
///   JoinHistory    the guests of each host by time, with the sizes up to which the joins hold
///   TreeEdges      the tree edges
///   WatchHeaps     the edges between two segments, each kept by one that blocks it
///
/// All other edges lie inside a segment and are not stored: the neighbour index finds them again.
/// An update runs Algorithm 1 again only where its outcome can differ (exact::ChangePropagation):
/// at new edges, at joins whose sizes changed, at watched edges of segments that changed, and,
/// where an old tree edge no longer joins, at the edges of explored points (exact::CutSearch).
/// exact::ComponentNames derives which points changed component.
///
/// Why it is exact, in short (F: final theta of a component):
/// 1. A component that is frozen at one edge never joins again. So an edge joins, or lies inside a
///    component, if and only if its weight is below both F. Edges of equal weight may come in any
///    order.
/// 2. A join stays as it is unless one of its components changes, either in size, which
///    JoinHistory::first_broken() finds, or in its points, which only happens at an edge that is
///    itself looked at.
/// 3. A blocked edge stays blocked until the segment that blocks it changes. Then its watch heap is
///    looked at.
/// 4. An edge inside a component stays inside unless the tree falls apart there, which the
///    invariant of CutSearch covers.
///
/// Fragments are not joined here: FragmentLayer does that on top.
///
/// Where a change is a large part of the map, or a correction turns out to reach far, the state is
/// rebuilt by Algorithm 1 over all points, which costs little more than `batch`.
class ExactEngine final : public IncrementalEngine {
 public:
  ExactEngine(const PointCloud& cloud, const EngineConfig& config);
  ~ExactEngine() override;

  RunStatistics update(const CloudChange& change) override;
  bool takes_moves_in_place() const override { return true; }
  void look_ahead(std::span<const CloudPoint> slice_W) override;
  std::span<const ComponentId> components() const override { return names_.of_points(); }
  std::span<const PointIndex> changed() const override { return names_.changed(); }
  double theta(ComponentId component) const override;
  const NeighbourIndex& neighbour_index() const override { return *index_; }
  std::unique_ptr<const PointRows> take_rows() override { return std::move(rows_); }
  PointIndex point_of(ComponentId component) const override { return names_.root(component); }
  void swap_to(SwapSpace& space) override;
  std::size_t bytes() const override;

 private:
  bool is_cheaper_to_rebuild(const CloudChange& change) const;
  void add_vertices(const CloudChange& change);
  void erase_watches_of(std::span<const PointIndex> removed);
  std::vector<exact::EdgeKey> find_new_edges(std::span<const PointIndex> added) const;
  void start_look_ahead();
  bool propagate(const CloudChange& change, std::vector<exact::EdgeKey> edges,
                 RunStatistics& statistics);
  void rebuild(const CloudChange& change, bool also_index, RunStatistics& statistics);

  const PointCloud& cloud_;
  EngineConfig config_;
  exact::JoinRule rule_;
  std::unique_ptr<NeighbourIndex> index_;
  exact::EdgeFinder edges_of_;
  exact::EdgesAhead edges_ahead_;
  std::vector<CloudPoint> next_slice_W_;  ///< the argument of look_ahead()
  exact::State state_;
  exact::ChangePropagation propagation_;
  exact::ComponentNames names_;
  std::int64_t num_points_ = 0;
  std::unique_ptr<PointRows> rows_;  ///< of the last update, if it was a rebuild; for take_rows()
};

}  // namespace kintsugi::segmenter

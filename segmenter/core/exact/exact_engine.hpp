#pragma once

#include <memory>
#include <span>
#include <vector>

#include "segmenter/core/engine/incremental_engine.hpp"
#include "segmenter/core/exact/component_names.hpp"
#include "segmenter/core/exact/edges_ahead.hpp"
#include "segmenter/core/exact/replay.hpp"
#include "segmenter/core/exact/state.hpp"

namespace kintsugi::segmenter {

/// Mode `exact`: the partition and every theta are those of `batch` after each update, at a cost
/// that depends on the change and hardly on the size of the map.
///
/// How it works. Algorithm 1 takes the edges of the graph in ascending order and joins components
/// while both are alive. What matters of that is remembered (exact::State), as a history in which
/// the key of an edge is the time at which it was looked at:
///
///   JoinForest   who absorbed whom and when; the component of a point at any time
///   JoinHistory  the joins of each host in order, with the sizes up to which they hold
///   TreeEdges    the edges that joined: a spanning tree of each segment
///   WatchHeaps   the edges between two segments, kept by a side that blocks them
///
/// All other edges lie inside a segment; they are found again in the neighbour index when needed.
/// An update runs Algorithm 1 again only where its outcome can differ (exact::Replay): the new
/// edges, joins whose sizes changed, watched edges of segments that changed; and where an old tree
/// edge no longer joins, the edges of the points that have to be looked at again
/// (exact::CutSearch). exact::ComponentNames tells which points changed component.
///
/// Why it is exact, in short (F: final theta of a component):
/// 1. Edges come in ascending order and theta of a component only matters at the weight at hand, so
///    a component that is frozen at one edge (weight >= theta) never joins again: an edge joins, or
///    is inside a component, iff its weight is below both F. Equal weights may come in any order.
/// 2. A join that was made stays made unless its components changed: sizes decide (first_broken),
///    or what they consist of does, and that only through an edge which is itself an event.
/// 3. A blocked edge stays blocked until the blocker changes; then its heap is opened.
/// 4. An edge inside a component stays so unless the tree falls apart: CutSearch's invariant.
///
/// Fragments stay as they are here: FragmentLayer joins them, on top.
///
/// Where the change is a large part of the map, or a correction turns out to reach far, the state
/// is built anew by Algorithm 1 over all points, which costs little more than `batch`.
class ExactEngine final : public IncrementalEngine {
 public:
  ExactEngine(const PointCloud& cloud, const EngineConfig& config);
  ~ExactEngine() override;

  RunStatistics update(const CloudChange& change) override;
  void look_ahead(std::span<const CloudPoint> slice_W) override;
  std::span<const ComponentId> components() const override { return names_.of_points(); }
  std::span<const PointIndex> changed() const override { return names_.changed(); }
  double theta(ComponentId component) const override;
  const NeighbourIndex& neighbour_index() const override { return *index_; }
  PointIndex point_of(ComponentId component) const override { return names_.root(component); }
  std::size_t bytes() const override;

 private:
  bool is_cheaper_to_rebuild(const CloudChange& change) const;
  void add_vertices(const CloudChange& change);
  void forget_watches_of(std::span<const PointIndex> removed);
  void update_index(const CloudChange& change);
  std::vector<exact::EdgeKey> find_new_edges(std::span<const PointIndex> added) const;
  void begin_to_look_ahead();
  bool replay(const CloudChange& change, std::vector<exact::EdgeKey> edges,
              RunStatistics& statistics);
  void rebuild(const CloudChange& change, RunStatistics& statistics);

  const PointCloud& cloud_;
  EngineConfig config_;
  exact::JoinRule rule_;
  std::unique_ptr<NeighbourIndex> index_;
  exact::EdgeFinder edges_of_;
  exact::EdgesAhead edges_ahead_;
  std::vector<CloudPoint> next_slice_W_;  ///< what look_ahead() told of
  exact::State state_;
  exact::Replay replay_;
  exact::ComponentNames names_;
  std::int64_t num_points_ = 0;
};

}  // namespace kintsugi::segmenter

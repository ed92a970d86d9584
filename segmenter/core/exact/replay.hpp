#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segmenter/core/exact/cut_search.hpp"
#include "segmenter/core/exact/event_queue.hpp"
#include "segmenter/core/exact/state.hpp"

namespace kintsugi::segmenter::exact {

/// Takes a change of the cloud through the history of joins: Algorithm 1 run again, but only where
/// its outcome may differ.
///
/// Events come in the order of edge keys; `now` is the key of the one at hand. What happened before
/// now is final. What the history says about later is kept as long as nothing contradicts it:
///
/// - A plain edge joins two components that are both alive. The guest, the one with fewer points in
///   the end, gives up its future: its later joins become events of their own. The host's stays.
///   An edge that a frozen component blocks is watched by it: a component never thaws, so the edge
///   matters again only when, in a later run, that component freezes at a heavier weight.
/// - A tree edge comes up when the size of a component below it changed, when its host can no
///   longer afford it, or when it was given up. It is decided anew; sizes are taken over.
/// - The heap of a segment that changed offers its watched edges while the component is alive.
/// - Where a tree edge of the old state no longer joins, CutSearch tells which points must look at
///   all their later edges again.
class Replay {
 public:
  Replay(State& state, const EdgeFinder& edges_of);

  /// `removed` are still among the vertices, `new_edges` are those of the points added; the
  /// finder knows the cloud as it is to be. Gives up, and leaves the state useless, when more than
  /// `max_explored` points had to be explored: returns false.
  bool run(std::span<const PointIndex> removed, std::vector<EdgeKey> new_edges,
           std::int64_t max_explored);

  /// Forgets a run that was given up.
  void reset();

  /// The vertices whose host changed, or what hangs on them; each is_touched.
  std::vector<PointIndex>& touched() { return touched_; }
  std::int64_t num_joins() const { return num_joins_; }
  std::int64_t num_events() const { return num_events_; }
  std::int64_t num_explored() const { return num_explored_; }

 private:
  void remove(PointIndex x);
  void handle(const Event& event);
  void settle(TreeEdgeId edge);
  bool still_holds(PointIndex guest);
  void decide(TreeEdgeId edge);
  void join(PointIndex host, PointIndex guest, TreeEdgeId edge);
  void give_up(PointIndex guest);
  void give_up_future(PointIndex x);
  void explore(PointIndex x);
  void offer_watches(PointIndex holder);
  void size_changed(PointIndex x);
  void queue_tree_edge_of(PointIndex x);
  void open_heap(PointIndex holder);
  void touch(PointIndex x);
  void finish(std::span<const PointIndex> removed);
  bool is_gone(PointIndex x) const { return state_.vertices[x].is_gone != 0; }

  State& state_;
  const EdgeFinder& edges_of_;
  CutSearch cut_search_;
  EventQueue queue_;
  EdgeKey now_;
  EdgeKey settled_;  ///< the last key at which an edge was decided
  std::vector<PointIndex> touched_;
  std::vector<PointIndex> opened_;     ///< holders of the heaps that take part
  std::vector<TreeEdgeId> new_edges_;  ///< joined something for the first time
  std::vector<TreeEdgeId> dropped_;    ///< of the old tree, join nothing any more
  struct Blocked {
    EdgeKey key;
    PointIndex watcher;
  };
  std::vector<Blocked> blocked_;  ///< to be watched when the run is over
  std::vector<JoinForest::Freed> freed_;
  std::int64_t num_joins_ = 0;
  std::int64_t num_events_ = 0;
  std::int64_t num_explored_ = 0;
};

}  // namespace kintsugi::segmenter::exact

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "segmenter/core/exact/cut_search.hpp"
#include "segmenter/core/exact/event_queue.hpp"
#include "segmenter/core/exact/state.hpp"

namespace kintsugi::segmenter::exact {

/// Updates the history of joins after a change of the cloud: runs Algorithm 1 again, but only where
/// its outcome may differ.
///
/// Events come in the order of their keys; `now` is the key of the current one. What happened
/// before now is final. The old history after now stays until something contradicts it:
///
/// - A plain edge joins two components if both are alive. The guest is the one that has fewer
/// points
///   in the end. Its future is taken back: the joins in it become events. The host's future stays.
///   If a component is frozen, it watches the edge from now on: the edge can matter again only when
///   that component freezes at a heavier weight in a later run.
/// - A tree edge becomes an event when the size of a component below it changed, when its host
/// would
///   be frozen, or when its join was taken back. It is decided again, with the present sizes.
/// - The watch heap of a segment that changed offers its edges as long as the component is alive.
/// - Where an edge of the old tree no longer joins, CutSearch finds the points to explore: all
/// their
///   later edges become events.
class ChangePropagation {
 public:
  ChangePropagation(State& state, const EdgeFinder& edges_of);

  /// touched() must hold the added points.
  /// @param removed points that are gone; their vertices are still in the state
  /// @param new_edges all edges of the added points; the index must hold the new cloud
  /// @return false when more than `max_explored` points had to be explored; the state then must be
  ///   rebuilt, after reset()
  bool run(std::span<const PointIndex> removed, std::vector<EdgeKey> new_edges,
           std::int64_t max_explored);

  /// Clears what a run that returned false left.
  void reset();

  /// The vertices whose host or guests changed; each is marked is_touched.
  std::vector<PointIndex>& touched() { return touched_; }
  std::int64_t num_joins() const { return num_joins_; }
  std::int64_t num_events() const { return num_events_; }
  std::int64_t num_explored() const { return num_explored_; }

 private:
  void remove(PointIndex x);
  void handle(const Event& event);
  void decide_again(TreeEdgeId edge);
  bool still_holds(PointIndex guest);
  void decide(TreeEdgeId edge);
  void join(PointIndex host, PointIndex guest, TreeEdgeId edge);
  void take_back(PointIndex guest);
  void take_back_future(PointIndex x);
  void explore(PointIndex x);
  void offer_watches(PointIndex holder);
  void size_changed(PointIndex x);
  void queue_tree_edge_of(PointIndex x);
  void open_heap(PointIndex holder);
  void touch(PointIndex x);
  void leave_queue();
  void finish(std::span<const PointIndex> removed);
  bool is_gone(PointIndex x) const { return state_.vertices[x].is_gone != 0; }

  State& state_;
  const EdgeFinder& edges_of_;
  CutSearch cut_search_;
  EventQueue queue_;
  EdgeKey now_;
  EdgeKey decided_;  ///< the last key at which an edge was decided
  std::vector<PointIndex> touched_;
  std::vector<PointIndex> explored_;
  std::vector<PointIndex> opened_;     ///< holders of the watch heaps that take part in the run
  std::vector<TreeEdgeId> new_edges_;  ///< tree edges that the run added
  std::vector<TreeEdgeId> dropped_;    ///< edges of the old tree that join nothing any more
  struct Blocked {
    EdgeKey key;
    PointIndex watcher;
  };
  std::vector<Blocked>
      blocked_;  ///< edges to be watched after the run: a heap in use must not get them
  std::vector<JoinForest::Freed> freed_;
  std::int64_t num_joins_ = 0;
  std::int64_t num_events_ = 0;
  std::int64_t num_explored_ = 0;
};

}  // namespace kintsugi::segmenter::exact

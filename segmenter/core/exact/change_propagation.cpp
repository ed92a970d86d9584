#include "segmenter/core/exact/change_propagation.hpp"

#include <cassert>
#include <utility>

namespace kintsugi::segmenter::exact {
namespace {

/// Earlier than every edge, since no edge has two equal points.
constexpr EdgeKey kStart{0, 0, 0};

constexpr std::size_t kPrefetchDistance = 8;  // edges

}  // namespace

ChangePropagation::ChangePropagation(State& state, const EdgeFinder& edges_of)
    : state_(state), edges_of_(edges_of), cut_search_(state.vertices, state.edges, state.forest) {}

bool ChangePropagation::run(std::span<const PointIndex> removed, std::vector<EdgeKey> new_edges,
                            std::int64_t max_explored) {
  now_ = decided_ = kStart;
  num_joins_ = num_events_ = num_explored_ = 0;
  queue_.start(std::move(new_edges));
  for (const PointIndex x : touched_) state_.vertices[x].is_in_queue = 1;
  for (const PointIndex x : removed) state_.vertices[x].is_gone = 1;
  for (const PointIndex x : removed) remove(x);
  while (!queue_.empty()) {
    if (const EdgeKey* const soon = queue_.upcoming(kPrefetchDistance)) {
      state_.vertices.prefetch(soon->a);
      state_.vertices.prefetch(soon->b);
    }
    handle(queue_.pop());
    if (num_explored_ > max_explored) return false;
  }
  finish(removed);
  return true;
}

void ChangePropagation::reset() {
  cut_search_.finish();
  leave_queue();
  touched_.clear();
  opened_.clear();
  new_edges_.clear();
  dropped_.clear();
  blocked_.clear();
}

/// Its edges are rejected when their events come. Before that, another vertex replaces it as a
/// host, so that its guests stay together where other edges connect them.
void ChangePropagation::remove(PointIndex x) {
  const PointIndex heir = state_.forest.step_down(x);
  touch(x);
  if (heir != kNone) {
    touch(heir);
    state_.watches.meld(heir, x);
  }
  state_.watches.erase_all_of(x);
  cut_search_.set_gone(x);
  state_.edges.for_each_linked(x, [&](TreeEdgeId edge, PointIndex) {
    queue_.push({state_.edges.key(edge), EventKind::kTreeEdge, edge});
  });
}

void ChangePropagation::handle(const Event& event) {
  ++num_events_;
  now_ = event.key;
  const bool is_decided = decided_ == now_;
  switch (event.kind) {
    case EventKind::kTreeEdge:
      if (!is_decided) {
        decided_ = now_;
        decide_again(event.argument);
      }
      break;
    case EventKind::kPlainEdge:
      if (!is_decided) {
        decided_ = now_;
        decide(kNone);
      }
      break;
    case EventKind::kHeap:
      offer_watches(event.argument);
      break;
  }
}

/// Decides a tree edge again, whether it still has an owner or its join was taken back.
void ChangePropagation::decide_again(TreeEdgeId edge) {
  const PointIndex owner = state_.edges.owner(edge);
  const bool is_rejected = is_gone(now_.a) || is_gone(now_.b);
  if (owner != kNone) {
    state_.vertices[owner].is_queued = 0;
    if (is_rejected || !still_holds(owner)) take_back(owner);
  }
  if (!is_rejected && state_.edges.owner(edge) == kNone) decide(edge);
  if (!state_.edges.is_linked(edge)) return;
  if (state_.edges.owner(edge) == kNone) dropped_.push_back(edge);
  for (const PointIndex x : cut_search_.reconcile(now_.a, now_.b, now_)) explore(x);
}

/// Whether the join of `guest` with its host still holds, with the present sizes.
bool ChangePropagation::still_holds(PointIndex guest) {
  const JoinForest& forest = state_.forest;
  const PointIndex host = state_.vertices.host(guest);
  const PointIndex a = forest.representative_before(now_.a, now_);
  const PointIndex b = forest.representative_before(now_.b, now_);
  if (!(a == guest && b == host) && !(a == host && b == guest)) return false;
  if (!forest.is_alive(host, now_)) {
    take_back_future(host);  // a frozen component makes none of its later joins
    return false;
  }
  if (!forest.is_alive(guest, now_)) return false;
  if (state_.forest.recount(guest)) size_changed(host);
  return true;
}

/// Algorithm 1, lines 7-11, for the edge of the current event. `edge`: its id if it has one.
void ChangePropagation::decide(TreeEdgeId edge) {
  const JoinForest& forest = state_.forest;
  const PointIndex a = forest.representative_before(now_.a, now_);
  const PointIndex b = forest.representative_before(now_.b, now_);
  if (a == b) return;
  if (!forest.is_alive(b, now_)) {
    blocked_.push_back({now_, now_.b});
  } else if (!forest.is_alive(a, now_)) {
    blocked_.push_back({now_, now_.a});
  } else if (forest.history().total(b) > forest.history().total(a)) {
    join(b, a, edge);
  } else {
    join(a, b, edge);
  }
}

void ChangePropagation::join(PointIndex host, PointIndex guest, TreeEdgeId edge) {
  ++num_joins_;
  if (edge == kNone) {
    edge = state_.edges.add(now_);
    new_edges_.push_back(edge);
  }
  take_back_future(guest);
  open_heap(guest);
  state_.forest.absorb(host, guest, edge);
  touch(guest);
  touch(host);
  size_changed(host);
}

/// Makes a guest a root again. If its tree edge is still to come, it becomes an event.
void ChangePropagation::take_back(PointIndex guest) {
  const TreeEdgeId edge = state_.vertices[guest].edge;
  const EdgeKey& key = state_.edges.key(edge);
  if (now_ < key) queue_.push({key, EventKind::kTreeEdge, edge});
  const PointIndex host = state_.forest.release(guest);
  touch(guest);
  touch(host);
  size_changed(host);
}

/// Takes back the future of `x`, which represents a component now.
void ChangePropagation::take_back_future(PointIndex x) {
  if (!state_.vertices.is_root(x) && !state_.forest.is_absorbed_up_to(x, now_)) take_back(x);
  freed_.clear();
  state_.forest.release_after(x, now_, freed_);
  if (freed_.empty()) return;
  for (const auto& [guest, edge] : freed_) {
    queue_.push({state_.edges.key(edge), EventKind::kTreeEdge, edge});
    touch(guest);
  }
  touch(x);
  size_changed(x);
}

/// Makes all later edges of x events, except those that are events already because of the point at
/// their other end.
void ChangePropagation::explore(PointIndex x) {
  ++num_explored_;
  state_.vertices[x].is_in_queue = 1;
  explored_.push_back(x);
  state_.watches.erase_all_of(x);
  if (!state_.forest.is_absorbed_up_to(x, now_)) take_back_future(x);
  state_.edges.for_each_linked(x, [&](TreeEdgeId edge, PointIndex other) {
    if (state_.vertices[other].is_in_queue) return;
    const EdgeKey& key = state_.edges.key(edge);
    if (now_ < key) queue_.push({key, EventKind::kTreeEdge, edge});
  });
  edges_of_.for_each({&x, 1}, [&](PointIndex, PointIndex other, const EdgeKey& key) {
    if (!state_.vertices[other].is_in_queue && now_ < key) queue_.push({.key = key});
  });
}

/// Decides the lightest watched edge of a segment that changed, if its component is alive at it.
/// All points of the segment that still have watches are in one component, by CutSearch's
/// invariant.
void ChangePropagation::offer_watches(PointIndex holder) {
  if (state_.watches.empty(holder)) return;
  const WatchHeaps::Watch& top = state_.watches.top(holder);
  if (top.key() == now_) {
    const PointIndex component = state_.forest.representative_before(top.watcher, now_);
    if (!state_.forest.is_alive(component, now_)) return;  // then it blocks all heavier ones, too
    state_.watches.pop(holder);
    if (!(decided_ == now_)) {
      decided_ = now_;
      decide(kNone);
    }
  }
  if (!state_.watches.empty(holder)) {
    queue_.push({state_.watches.top(holder).key(), EventKind::kHeap, holder});
  }
}

/// To be called when the component of x has more or fewer points than before, at any time from now
/// on.
void ChangePropagation::size_changed(PointIndex x) {
  if (state_.vertices.is_root(x)) {
    open_heap(x);
  } else {
    queue_tree_edge_of(x);
  }
  const PointIndex broken = state_.forest.history().first_broken(x);
  if (broken != kNone) queue_tree_edge_of(broken);
}

void ChangePropagation::queue_tree_edge_of(PointIndex x) {
  Vertex& v = state_.vertices[x];
  if (state_.vertices.is_root(x) || v.is_queued || !(now_ < state_.edges.key(v.edge))) return;
  v.is_queued = 1;
  queue_.push({state_.edges.key(v.edge), EventKind::kTreeEdge, v.edge});
}

void ChangePropagation::open_heap(PointIndex holder) {
  Vertex& v = state_.vertices[holder];
  if (v.is_heap_open || state_.watches.empty(holder)) return;
  v.is_heap_open = 1;
  opened_.push_back(holder);
  queue_.push({state_.watches.top(holder).key(), EventKind::kHeap, holder});
}

void ChangePropagation::touch(PointIndex x) {
  Vertex& v = state_.vertices[x];
  if (v.is_touched) return;
  v.is_touched = 1;
  touched_.push_back(x);
}

void ChangePropagation::leave_queue() {
  for (const PointIndex x : touched_) state_.vertices[x].is_in_queue = 0;
  for (const PointIndex x : std::exchange(explored_, {})) state_.vertices[x].is_in_queue = 0;
}

/// Updates the old tree and the watch heaps for the next run.
void ChangePropagation::finish(std::span<const PointIndex> removed) {
  for (const PointIndex holder : std::exchange(opened_, {})) {
    state_.vertices[holder].is_heap_open = 0;
    if (state_.watches.empty(holder)) continue;
    state_.watches.meld(state_.forest.root(state_.watches.top(holder).watcher), holder);
  }
  for (const auto& [key, watcher] : std::exchange(blocked_, {})) {
    state_.watches.insert(state_.forest.root(watcher), watcher, key);
  }
  for (const TreeEdgeId edge : std::exchange(dropped_, {})) {
    state_.edges.unlink(edge);
    state_.edges.release(edge);
  }
  for (const TreeEdgeId edge : std::exchange(new_edges_, {})) {
    if (state_.edges.owner(edge) != kNone) {
      state_.edges.link(edge);
    } else {
      state_.edges.release(edge);
    }
  }
  cut_search_.finish();
  leave_queue();
  for ([[maybe_unused]] const PointIndex x : removed) {
    assert(state_.vertices.is_root(x) && state_.vertices[x].history == kNone);
    assert(state_.vertices[x].half_edges == kNone && state_.vertices[x].watches == kNone);
  }
}

}  // namespace kintsugi::segmenter::exact

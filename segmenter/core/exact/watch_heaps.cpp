#include "segmenter/core/exact/watch_heaps.hpp"

#include <utility>

namespace kintsugi::segmenter::exact {

void WatchHeaps::insert(PointIndex holder, PointIndex watcher, const EdgeKey& key) {
  const PointIndex other = key.a == watcher ? key.b : key.a;
  if (find(watcher, other) != kNone) return;
  WatchId id = first_free_;
  if (id != kNone) {
    first_free_ = watches_[id].next;
    --num_free_;
  } else {
    id = static_cast<WatchId>(watches_.size());
    watches_.resize(watches_.size() + 1);
  }
  watches_[id] = {watcher, other, key.weight_bits, kNone, kNone, kNone, vertices_[watcher].watches};
  vertices_[watcher].watches = id;
  set_top(holder, meld_trees(vertices_[holder].heap, id));
}

void WatchHeaps::meld(PointIndex to, PointIndex from) {
  if (to == from) return;
  const WatchId taken = std::exchange(vertices_[from].heap, kNone);
  set_top(to, meld_trees(vertices_[to].heap, taken));
}

WatchId WatchHeaps::find(PointIndex watcher, PointIndex other) const {
  WatchId id = vertices_[watcher].watches;
  while (id != kNone && watches_[id].other != other) id = watches_[id].next_of_watcher;
  return id;
}

void WatchHeaps::erase_all_of(PointIndex watcher) {
  while (vertices_[watcher].watches != kNone) erase(vertices_[watcher].watches);
}

void WatchHeaps::erase(PointIndex watcher, PointIndex other) {
  const WatchId id = find(watcher, other);
  if (id != kNone) erase(id);
}

/// Its children, melded into one tree, take its place. They are not lighter than its parent.
void WatchHeaps::erase(WatchId id) {
  const WatchId heir = meld_children(id);
  const Watch& watch = watches_[id];
  if (watch.prev == kNone) {
    set_top(watch.next, heir);
  } else {
    Watch& prev = watches_[watch.prev];
    (prev.child == id ? prev.child : prev.next) = heir != kNone ? heir : watch.next;
    if (heir != kNone) {
      watches_[heir].prev = watch.prev;
      watches_[heir].next = watch.next;
    }
    if (watch.next != kNone) watches_[watch.next].prev = heir != kNone ? heir : watch.prev;
  }
  unlist(id);
  watches_[id].next = std::exchange(first_free_, id);
  ++num_free_;
}

void WatchHeaps::unlist(WatchId id) {
  WatchId* at = &vertices_[watches_[id].watcher].watches;
  while (*at != id) at = &watches_[*at].next_of_watcher;
  *at = watches_[id].next_of_watcher;
}

void WatchHeaps::set_top(PointIndex holder, WatchId id) {
  vertices_[holder].heap = id;
  if (id == kNone) return;
  watches_[id].prev = kNone;
  watches_[id].next = holder;
}

/// Melds two trees. The caller links the result to its siblings.
WatchId WatchHeaps::meld_trees(WatchId a, WatchId b) {
  if (a == kNone) return b;
  if (b == kNone) return a;
  if (watches_[b].key() < watches_[a].key()) std::swap(a, b);
  Watch& top = watches_[a];
  watches_[b].next = top.child;
  watches_[b].prev = a;
  if (top.child != kNone) watches_[top.child].prev = b;
  top.child = b;
  return a;
}

/// Melds in pairs from left to right, then the pairs from right to left.
WatchId WatchHeaps::meld_children(WatchId id) {
  pairs_.clear();
  for (WatchId child = std::exchange(watches_[id].child, kNone); child != kNone;) {
    const WatchId second = watches_[child].next;
    const WatchId rest = second == kNone ? kNone : watches_[second].next;
    pairs_.push_back(meld_trees(child, second));
    child = rest;
  }
  WatchId melded = kNone;
  for (; !pairs_.empty(); pairs_.pop_back()) melded = meld_trees(pairs_.back(), melded);
  return melded;
}

}  // namespace kintsugi::segmenter::exact

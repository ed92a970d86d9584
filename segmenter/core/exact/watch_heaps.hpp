#pragma once

#include <bit>
#include <cstddef>
#include <vector>

#include "segmenter/core/exact/edge_key.hpp"
#include "segmenter/core/exact/vertex.hpp"

namespace kintsugi::segmenter::exact {

/// The edges between two segments, each watched by a side that blocks it.
///
/// Each segment has one heap of watches, the lightest edge on top. It belongs to a vertex that is
/// called its holder: between runs the root. The watcher is that end of the edge which lies in the
/// blocking segment. Each point has a list of the watches of which it is the watcher, so these can
/// be removed from whatever heap they are in. An edge that has come to lie inside a segment may
/// stay watched until the segment is alive at it; it then joins nothing.
///
/// The heaps are pairing heaps: meld and insert cost O(1), removal O(log n) amortised.
class WatchHeaps {
 public:
  explicit WatchHeaps(Vertices& vertices) : vertices_(vertices) {}

  struct Watch {
    PointIndex watcher;  ///< in the segment that blocks the edge
    PointIndex other;    ///< the other end
    EdgeKey key() const { return EdgeKey::of(std::bit_cast<float>(weight_bits), watcher, other); }

    std::uint32_t weight_bits;
    WatchId child;            ///< first child in the heap
    WatchId next;             ///< next sibling; for the top of a heap: the holder
    WatchId prev;             ///< previous sibling, or the parent; kNone: it is the top
    WatchId next_of_watcher;  ///< in the list of the watcher
  };

  /// Adds a watch of the edge `key` to the heap of `holder`. `watcher` is one end of the edge.
  /// Nothing happens when it watches the edge already.
  void insert(PointIndex holder, PointIndex watcher, const EdgeKey& key);

  bool empty(PointIndex holder) const { return vertices_[holder].heap == kNone; }
  /// The watch of the lightest edge. The heap must not be empty.
  const Watch& top(PointIndex holder) const { return watches_[vertices_[holder].heap]; }
  const Watch& operator[](WatchId id) const { return watches_[id]; }
  void pop(PointIndex holder) { erase(vertices_[holder].heap); }
  /// Moves all watches of `from` to `to`.
  void meld(PointIndex to, PointIndex from);

  /// Removes all watches of `watcher`.
  void erase_all_of(PointIndex watcher);
  /// Removes the watch of the edge (watcher, other), if `watcher` watches it.
  void erase(PointIndex watcher, PointIndex other);

  /// Removes all watches. The lists at the vertices are left as they are.
  void clear() {
    watches_.clear();
    first_free_ = kNone;
    num_free_ = 0;
  }

  std::size_t size() const { return watches_.size() - num_free_; }
  void swap_to(SwapSpace& space) { watches_.swap_to(space); }
  std::size_t bytes() const { return watches_.bytes(); }

 private:
  WatchId find(PointIndex watcher, PointIndex other) const;
  void erase(WatchId id);
  void unlist(WatchId id);
  void set_top(PointIndex holder, WatchId id);
  WatchId meld_trees(WatchId a, WatchId b);
  WatchId meld_children(WatchId id);

  Vertices& vertices_;
  GrowingArray<Watch> watches_;
  WatchId first_free_ = kNone;
  std::size_t num_free_ = 0;
  std::vector<WatchId> pairs_;  ///< scratch of meld_children()
};

}  // namespace kintsugi::segmenter::exact

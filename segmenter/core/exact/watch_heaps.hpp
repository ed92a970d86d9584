#pragma once

#include <bit>
#include <cstddef>
#include <vector>

#include "segmenter/core/exact/edge_key.hpp"
#include "segmenter/core/exact/vertex.hpp"

namespace kintsugi::segmenter::exact {

/// The edges between two segments, each watched by a side that blocks it.
///
/// Each segment has one heap of watches, lightest edge first, at a vertex that is called its
/// holder (the root, between runs). A watch stands at the point that is the edge's end in the
/// blocking segment, so that all watches of a point are found and can be taken out of whatever
/// heap they are in. An edge that has come to lie inside a segment may stay watched until the
/// segment is alive at it; it then joins nothing. Pairing heaps: melding and insertion cost O(1),
/// taking out O(log n) amortised.
class WatchHeaps {
 public:
  explicit WatchHeaps(Vertices& vertices) : vertices_(vertices) {}

  struct Watch {
    PointIndex watcher;  ///< in the segment that blocks the edge
    PointIndex other;    ///< the other end
    EdgeKey key() const { return EdgeKey::of(std::bit_cast<float>(weight_bits), watcher, other); }

    std::uint32_t weight_bits;
    WatchId child;  ///< first child in the heap
    WatchId next;   ///< next sibling; of the top: its holder
    WatchId prev;   ///< previous sibling, or the parent; kNone: the top
    WatchId next_of_watcher;
  };

  /// Watches the edge of `key` at `watcher`, one of its ends, in the heap of `holder`; does
  /// nothing when `watcher` watches it already.
  void insert(PointIndex holder, PointIndex watcher, const EdgeKey& key);

  bool empty(PointIndex holder) const { return vertices_[holder].heap == kNone; }
  /// The lightest watch of `holder`, which has one.
  const Watch& top(PointIndex holder) const { return watches_[vertices_[holder].heap]; }
  const Watch& operator[](WatchId id) const { return watches_[id]; }
  void pop(PointIndex holder) { erase(vertices_[holder].heap); }
  /// Moves all watches of `from` to `to`.
  void meld(PointIndex to, PointIndex from);

  /// Takes out all watches that stand at `watcher`.
  void erase_all_of(PointIndex watcher);
  /// Takes out the watch of the edge (watcher, other), if `watcher` watches it.
  void erase(PointIndex watcher, PointIndex other);

  /// Forgets all, at the vertices excepted.
  void clear() {
    watches_.clear();
    first_free_ = kNone;
    num_free_ = 0;
  }

  std::size_t size() const { return watches_.size() - num_free_; }
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

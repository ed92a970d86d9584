#pragma once

#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "segmenter/core/exact/vertex.hpp"
#include "segmenter/core/exact/watch_heaps.hpp"

namespace kintsugi::segmenter::exact::testing {

/// A watch, as found in a heap or in the list of a point.
struct KnownWatch {
  EdgeKey key;
  PointIndex watcher = kNone;
  bool operator<(const KnownWatch& other) const {
    return key == other.key ? watcher < other.watcher : key < other.key;
  }
  bool operator==(const KnownWatch&) const = default;
};

/// Follows the links between watches and checks that they form heaps.
class WatchCheck {
 public:
  WatchCheck(const Vertices& vertices, const WatchHeaps& watches)
      : vertices_(vertices), watches_(watches) {}

  std::multiset<KnownWatch> in_heap_of(PointIndex holder) const {
    std::multiset<KnownWatch> found;
    const WatchId top = vertices_[holder].heap;
    if (top == kNone) return found;
    EXPECT_EQ(watches_[top].prev, kNone) << "top of " << holder;
    EXPECT_EQ(watches_[top].next, holder) << "top of " << holder;
    collect(top, found);
    EXPECT_EQ(found.begin()->key, watches_[top].key()) << "top of " << holder;
    return found;
  }

  std::multiset<KnownWatch> at_watcher(PointIndex watcher) const {
    std::multiset<KnownWatch> found;
    for (WatchId id = vertices_[watcher].watches; id != kNone; id = watches_[id].next_of_watcher) {
      EXPECT_EQ(watches_[id].watcher, watcher);
      found.insert({watches_[id].key(), watcher});
    }
    return found;
  }

  /// In whose heap the watch is.
  PointIndex holder_of(WatchId id) const {
    while (watches_[id].prev != kNone) id = watches_[id].prev;
    return watches_[id].next;
  }

 private:
  void collect(WatchId id, std::multiset<KnownWatch>& found) const {
    const WatchHeaps::Watch& watch = watches_[id];
    found.insert({watch.key(), watch.watcher});
    WatchId prev = id;
    for (WatchId child = watch.child; child != kNone; child = watches_[child].next) {
      EXPECT_EQ(watches_[child].prev, prev);
      EXPECT_FALSE(watches_[child].key() < watch.key());
      collect(child, found);
      prev = child;
    }
  }

  const Vertices& vertices_;
  const WatchHeaps& watches_;
};

}  // namespace kintsugi::segmenter::exact::testing

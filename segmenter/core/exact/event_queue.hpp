#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "segmenter/core/exact/edge_key.hpp"

namespace kintsugi::segmenter::exact {

/// What there is to do at the time of an edge; at one time in this order.
enum class EventKind : std::uint32_t {
  kTreeEdge,   ///< decide a tree edge again; argument: its id
  kPlainEdge,  ///< decide an edge that has joined nothing so far; no argument
  kHeap,       ///< offer the watched edges of a segment that changed; argument: holder of the heap
};

struct Event {
  EdgeKey key;
  EventKind kind = EventKind::kPlainEdge;
  std::uint32_t argument = 0;

  bool operator<(const Event& other) const {
    if (!(key == other.key)) return key < other.key;
    return kind < other.kind;
  }
};

/// Sorts keys, in linear time except among keys of equal weight.
void sort_keys(std::vector<EdgeKey>& keys);

/// The events of a run in order. Most of them, the edges of the new points, are known at its start
/// and sorted once. The others, a few hundred, are kept in a binary heap.
class EventQueue {
 public:
  /// Begins a run with these plain edges, in any order.
  void start(std::vector<EdgeKey> edges) {
    edges_ = std::move(edges);
    sort_keys(edges_);
    next_ = 0;
    heap_.clear();
  }

  void push(const Event& event) {
    heap_.push_back(event);
    std::push_heap(heap_.begin(), heap_.end(), later);
  }

  bool empty() const { return next_ == edges_.size() && heap_.empty(); }

  /// Removes and returns the earliest event. The queue must not be empty.
  Event pop() {
    if (next_ < edges_.size()) {
      const Event edge{.key = edges_[next_]};
      if (heap_.empty() || edge < heap_.front()) {
        ++next_;
        return edge;
      }
    }
    std::pop_heap(heap_.begin(), heap_.end(), later);
    const Event event = heap_.back();
    heap_.pop_back();
    return event;
  }

  /// The plain edge that is `ahead` edges from now; nullptr when there are not so many.
  const EdgeKey* upcoming(std::size_t ahead) const {
    return edges_.size() - next_ > ahead ? &edges_[next_ + ahead] : nullptr;
  }

 private:
  static bool later(const Event& x, const Event& y) { return y < x; }

  std::vector<EdgeKey> edges_;
  std::size_t next_ = 0;
  std::vector<Event> heap_;
};

}  // namespace kintsugi::segmenter::exact

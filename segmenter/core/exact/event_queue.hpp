#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "segmenter/core/exact/edge_key.hpp"

namespace kintsugi::segmenter::exact {

/// What is to be looked at, at the key of an edge. At one key, in this order.
enum class EventKind : std::uint32_t {
  kTreeEdge,   ///< a tree edge whose join may not hold, or not as it was; argument: its id
  kPlainEdge,  ///< an edge that may join; no argument
  kHeap,       ///< a watch of a touched segment; argument: the holder of the heap
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

/// Sorts keys; in time proportional to their number, but for those of equal weight.
void sort_keys(std::vector<EdgeKey>& keys);

/// The events of a run in order. Most are known at its start, the edges of the new points: those
/// are sorted once; the others, a few hundred, come and go in a binary heap.
class EventQueue {
 public:
  /// Begins a run. `edges`, in any order, are its plain edges.
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

  /// The earliest event, which there is.
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

  /// The plain edge that comes `ahead` edges from now; nullptr when there are not so many.
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

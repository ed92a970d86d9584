#pragma once

#include <cstdint>

#include "lcmtypes/base/growing_array.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter::exact {

/// No vertex, no tree edge, no watch.
inline constexpr std::uint32_t kNone = UINT32_MAX;

using TreeEdgeId = std::uint32_t;
using WatchId = std::uint32_t;

/// When a vertex was absorbed, and by which host. Stored apart from the rest of the vertex: to find
/// the component of a point, only these are read, eight to a cache line.
struct Absorption {
  PointIndex host = kNone;                 ///< kNone: a root
  std::uint32_t weight_bits = UINT32_MAX;  ///< of the tree edge that did it
};

/// What else the engine keeps for a point, in one cache line. Each group of members belongs to the
/// class that is named above it.
struct alignas(64) Vertex {
  // JoinForest: its absorption, beside Absorption.
  TreeEdgeId edge = kNone;  ///< the tree edge that did it
  std::uint32_t size = 0;   ///< points of its component then

  // JoinHistory: its node in the history of its host.
  std::uint32_t weight_bits = UINT32_MAX;  ///< as in its Absorption
  PointIndex left = kNone;
  PointIndex right = kNone;
  std::uint32_t sum = 0;      ///< of `size` in the subtree
  std::int32_t capacity = 0;  ///< see JoinHistory
  std::int32_t slack = 0;     ///< least capacity - points gained, in the subtree

  // JoinHistory: its own history.
  PointIndex history = kNone;
  std::uint32_t last_weight_bits = 0;  ///< of the last join in it; 0: none

  // WatchHeaps.
  WatchId heap = kNone;     ///< of a root: the watch heap of its segment
  WatchId watches = kNone;  ///< first of the watches whose watcher is this point

  // TreeEdges.
  std::uint32_t half_edges = kNone;  ///< first of its list

  // Used within one run, and zero between runs; except is_gone.
  std::uint32_t family = 0;            ///< CutSearch: 0 where not explored
  std::uint32_t visit = 0;             ///< scratch of a search
  std::uint32_t is_queued : 1 = 0;     ///< its tree edge is in the event queue
  std::uint32_t is_heap_open : 1 = 0;  ///< its heap takes part in the run
  std::uint32_t is_touched : 1 = 0;    ///< its host or guests changed
  std::uint32_t is_in_queue : 1 = 0;   ///< all its edges from now on are events
  std::uint32_t is_gone : 1 = 0;       ///< not in the cloud (any more)
};
static_assert(sizeof(Absorption) == 8 && sizeof(Vertex) == 64);

/// All vertices, by point.
class Vertices {
 public:
  std::size_t size() const { return records_.size(); }
  /// New vertices are marked as gone: their points are not in the cloud yet.
  void resize(std::size_t size) {
    Vertex absent;
    absent.is_gone = 1;
    records_.resize(size, absent);
    absorptions_.resize(size, {});
  }
  /// Makes x a component of its own, without a history.
  void reset(PointIndex x) {
    records_[x] = {};
    absorptions_[x] = {};
  }

  Vertex& operator[](PointIndex x) { return records_[x]; }
  const Vertex& operator[](PointIndex x) const { return records_[x]; }

  const Absorption& absorption(PointIndex x) const { return absorptions_[x]; }
  PointIndex host(PointIndex x) const { return absorptions_[x].host; }
  bool is_root(PointIndex x) const { return absorptions_[x].host == kNone; }
  void set_absorbed(PointIndex x, PointIndex host, TreeEdgeId edge, std::uint32_t weight_bits) {
    absorptions_[x] = {host, weight_bits};
    records_[x].weight_bits = weight_bits;
    records_[x].edge = edge;
  }
  void set_host(PointIndex x, PointIndex host) { absorptions_[x].host = host; }
  void set_free(PointIndex x) { set_absorbed(x, kNone, kNone, UINT32_MAX); }
  /// Prefetch the absorption of x, or the rest of it.
  void prefetch(PointIndex x) const { __builtin_prefetch(&absorptions_.data()[x]); }
  void prefetch_record(PointIndex x) const { __builtin_prefetch(&records_.data()[x]); }

  void swap_to(SwapSpace& space) {
    records_.swap_to(space);
    absorptions_.swap_to(space);
  }
  std::size_t bytes() const { return records_.bytes() + absorptions_.bytes(); }

 private:
  GrowingArray<Vertex> records_;
  GrowingArray<Absorption> absorptions_;
};

}  // namespace kintsugi::segmenter::exact

#pragma once

#include <cstdint>

#include "lcmtypes/base/growing_array.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter::exact {

/// None of whatever an index counts: vertices, tree edges, watches.
inline constexpr std::uint32_t kNone = UINT32_MAX;

using TreeEdgeId = std::uint32_t;
using WatchId = std::uint32_t;

/// When the component that a vertex stands for was absorbed into another, and by whom. Apart from
/// the rest: finding the component of a point climbs along these, eight to a cache line.
struct Absorption {
  PointIndex host = kNone;                 ///< representative that absorbed it; kNone: a root
  std::uint32_t weight_bits = UINT32_MAX;  ///< of the tree edge that did it
};

/// What else the engine keeps for a point: one cache line, shared by the parts named at each group.
struct alignas(64) Vertex {
  // JoinForest: its absorption.
  TreeEdgeId edge = kNone;  ///< the tree edge that did it
  std::uint32_t size = 0;   ///< points it brought along

  // JoinHistory: its node in the history of its host.
  std::uint32_t weight_bits = UINT32_MAX;  ///< as in its Absorption
  PointIndex left = kNone;
  PointIndex right = kNone;
  std::uint32_t sum = 0;      ///< of `size` in the subtree
  std::int32_t capacity = 0;  ///< the most points the host may have gained up to this join
  std::int32_t slack = 0;     ///< least capacity - points gained, in the subtree

  // JoinHistory: its own history.
  PointIndex history = kNone;
  std::uint32_t last_weight_bits = 0;  ///< of the last join in it; 0: none

  // WatchHeaps.
  WatchId heap = kNone;     ///< of a root: the edges its segment blocks
  WatchId watches = kNone;  ///< the entries that stand at this point

  // TreeEdges.
  std::uint32_t half_edges = kNone;  ///< first of its list

  // One run; all zero between runs, but for is_gone.
  std::uint32_t family = 0;            ///< CutSearch: of an explored vertex
  std::uint32_t visit = 0;             ///< scratch of a search
  std::uint32_t is_queued : 1 = 0;     ///< its tree edge is in the event queue
  std::uint32_t is_heap_open : 1 = 0;  ///< its heap takes part in the run
  std::uint32_t is_touched : 1 = 0;    ///< its host changed, or what hangs on it
  std::uint32_t is_gone : 1 = 0;       ///< not in the cloud (any more)
};
static_assert(sizeof(Absorption) == 8 && sizeof(Vertex) == 64);

/// All vertices, by point.
class Vertices {
 public:
  std::size_t size() const { return records_.size(); }
  /// New vertices are gone: not in the cloud yet.
  void resize(std::size_t size) {
    Vertex nobody;
    nobody.is_gone = 1;
    records_.resize(size, nobody);
    absorptions_.resize(size, {});
  }
  /// Makes x a single point that nothing has happened to.
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
  /// Memory is fetched ahead of its use: the absorption, or the rest.
  void prefetch(PointIndex x) const { __builtin_prefetch(&absorptions_.data()[x]); }
  void prefetch_record(PointIndex x) const { __builtin_prefetch(&records_.data()[x]); }

  std::size_t bytes() const { return records_.bytes() + absorptions_.bytes(); }

 private:
  GrowingArray<Vertex> records_;
  GrowingArray<Absorption> absorptions_;
};

}  // namespace kintsugi::segmenter::exact

#pragma once

#include <cstdint>

#include "segmenter/core/growing_array.hpp"
#include "segmenter/core/point_cloud.hpp"

namespace kintsugi::segmenter::exact {

/// None of whatever an index counts: vertices, tree edges, watches.
inline constexpr std::uint32_t kNone = UINT32_MAX;

using TreeEdgeId = std::uint32_t;
using WatchId = std::uint32_t;

/// What the engine keeps for a point: one cache line, shared by the parts named at each group.
struct alignas(64) Vertex {
  // JoinForest: the join at which its component was absorbed into another.
  PointIndex host = kNone;                 ///< representative that absorbed it; kNone: a root
  std::uint32_t weight_bits = UINT32_MAX;  ///< of `edge`, here as well: climbing reads it all along
  TreeEdgeId edge = kNone;                 ///< the tree edge that did it
  std::uint32_t size = 0;                  ///< points it brought along

  // JoinHistory: its node in the history of `host`, and its own history.
  PointIndex left = kNone;
  PointIndex right = kNone;
  std::uint32_t sum = 0;      ///< of `size` in the subtree
  std::int32_t capacity = 0;  ///< the most points the host may have gained up to this join
  std::int32_t slack = 0;     ///< least capacity - points gained, in the subtree
  PointIndex history = kNone;

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

  bool is_root() const { return host == kNone; }
};
static_assert(sizeof(Vertex) == 64);

using Vertices = GrowingArray<Vertex>;

}  // namespace kintsugi::segmenter::exact

#pragma once

#include <span>

#include "segmenter/core/graph/grid_index.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"

namespace kintsugi::segmenter {

/// Finds the neighbours of one point after the other in an index of any kind; fast for a GridIndex.
/// Valid until the index changes.
class NeighbourCursor {
 public:
  explicit NeighbourCursor(const NeighbourIndex& index)
      : index_(index), grid_(dynamic_cast<const GridIndex*>(&index)) {
    if (grid_ != nullptr) cursor_ = GridIndex::Cursor(*grid_);
  }

  /// Calls fn(PointIndex) for each neighbour of `point`, in no particular order.
  template <typename Fn>
  void for_each_neighbour(PointIndex point, Fn&& fn) {
    if (grid_ != nullptr) return cursor_.for_each_neighbour(point, fn);
    index_.visit({&point, 1}, [&](PointIndex /*point*/, std::span<const PointIndex> neighbours) {
      for (const PointIndex neighbour : neighbours) fn(neighbour);
    });
  }

 private:
  const NeighbourIndex& index_;
  const GridIndex* grid_;  ///< the same index; null if it is of another kind
  GridIndex::Cursor cursor_;
};

}  // namespace kintsugi::segmenter

#pragma once

#include <span>

#include "segmenter/core/graph/grid_index.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"

namespace kintsugi::segmenter {

/// The neighbours of one point after the other, in any index; quick in a grid. Valid until the
/// index changes.
class NeighbourCursor {
 public:
  explicit NeighbourCursor(const NeighbourIndex& index)
      : index_(index), grid_(dynamic_cast<const GridIndex*>(&index)) {
    if (grid_ != nullptr) cursor_ = GridIndex::Cursor(*grid_);
  }

  /// Calls fn(PointIndex) with each neighbour of `point`, in no particular order.
  template <typename Fn>
  void for_each_neighbour(PointIndex point, Fn&& fn) {
    if (grid_ != nullptr) return cursor_.for_each_neighbour(point, fn);
    index_.visit({&point, 1}, [&](PointIndex /*point*/, std::span<const PointIndex> neighbours) {
      for (const PointIndex neighbour : neighbours) fn(neighbour);
    });
  }

 private:
  const NeighbourIndex& index_;
  const GridIndex* grid_;  ///< the same; none: it is of another kind
  GridIndex::Cursor cursor_;
};

}  // namespace kintsugi::segmenter

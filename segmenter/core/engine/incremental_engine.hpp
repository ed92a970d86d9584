#pragma once

#include <memory>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/core/points/point_rows.hpp"

namespace kintsugi::segmenter {

/// An engine that keeps an index of the neighbours of its points, which a layer on top of it can
/// use.
class IncrementalEngine : public SegmentationEngine {
 public:
  /// Holds the points of the last update.
  virtual const NeighbourIndex& neighbour_index() const = 0;

  /// The points of the cloud in rows, where the last update made them anyway; once. Else null.
  virtual std::unique_ptr<const PointRows> take_rows() { return nullptr; }

  /// Any one point of an existing component.
  virtual PointIndex point_of(ComponentId component) const = 0;
};

}  // namespace kintsugi::segmenter

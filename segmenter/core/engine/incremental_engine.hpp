#pragma once

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"

namespace kintsugi::segmenter {

/// An engine that keeps the neighbours of its points, for a layer on top of it.
class IncrementalEngine : public SegmentationEngine {
 public:
  /// Of the points at the last update().
  virtual const NeighbourIndex& neighbour_index() const = 0;

  /// Some point of a component that there is.
  virtual PointIndex point_of(ComponentId component) const = 0;
};

}  // namespace kintsugi::segmenter

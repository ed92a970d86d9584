#pragma once

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"

namespace kintsugi::segmenter {

/// An engine that keeps an index of the neighbours of its points, which a layer on top of it can
/// use.
class IncrementalEngine : public SegmentationEngine {
 public:
  /// Holds the points of the last update.
  virtual const NeighbourIndex& neighbour_index() const = 0;

  /// Any one point of an existing component.
  virtual PointIndex point_of(ComponentId component) const = 0;
};

}  // namespace kintsugi::segmenter

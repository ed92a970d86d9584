#pragma once
// A surface with shape features, thinned further: descriptions cost much time, and need less detail
// than poses.

#include <vector>

#include "segmenter/objects/recognition/shape_features.hpp"
#include "segmenter/objects/recognition/surface.hpp"
#include "segmenter/objects/recognition/view_descriptor.hpp"

namespace kintsugi::segmenter {

/// The spacing at which surfaces are described, where they are compared at `spacing_m`.
float described_spacing_m(float spacing_m);

struct DescribedSurface {
  /// @param surface thinned to `described_spacing_m`
  DescribedSurface(Surface surface, float described_spacing_m);

  float spacing_m;  ///< of these points
  Surface surface;
  ShapeFeatures features;  ///< of each point
};

/// The descriptors of what can be seen of the object from around it.
std::vector<ViewDescriptor> descriptors_of_views(const DescribedSurface& described);

}  // namespace kintsugi::segmenter

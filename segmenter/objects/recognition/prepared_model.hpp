#pragma once
// An object of the library with what recognition computes of it once.

#include <span>
#include <vector>

#include "segmenter/objects/model/object_model.hpp"
#include "segmenter/objects/recognition/agreement.hpp"
#include "segmenter/objects/recognition/scene_surface.hpp"
#include "segmenter/objects/recognition/shape_features.hpp"
#include "segmenter/objects/recognition/surface.hpp"
#include "segmenter/objects/recognition/surface_field.hpp"
#include "segmenter/objects/recognition/view_descriptor.hpp"

namespace kintsugi::segmenter {

/// The spacing at which surfaces are described, where they are compared at `spacing_m`.
float described_spacing_m(float spacing_m);

/// A surface with shape features, thinned further: descriptors cost much time, and need less detail
/// than poses.
struct DescribedSurface {
  /// @param map_spacing_m of the points as they are compared
  DescribedSurface(std::span<const CloudPoint> points, float map_spacing_m);

  [[nodiscard]] ViewDescriptor descriptor() const;

  float spacing_m;  ///< of these points
  Surface surface;
  ShapeFeatures features;  ///< of each point
};

/// The descriptors of what can be seen of the object from around it.
std::vector<ViewDescriptor> descriptors_of_views(const DescribedSurface& described);

struct PreparedModel {
  /// @param spacing_m of the surfaces that are compared: the larger of the resolutions of model and
  ///   map
  PreparedModel(const ObjectModel& object, float spacing_m);

  const ObjectModel* object;
  float spacing_m;
  Surface surface_O;
  float radius_m;  ///< half the diagonal of its box
  SurfaceField field;
  SceneSurface points_O;  ///< the same surface, for what `field` gets wrong at edges
  /// The same at the spacing of descriptors, for ModelIndex.
  DescribedSurface described;
};

}  // namespace kintsugi::segmenter

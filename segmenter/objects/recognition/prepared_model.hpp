#pragma once
// An object of the library with what recognition computes of it once.

#include <memory>
#include <vector>

#include "segmenter/objects/model/object_model.hpp"
#include "segmenter/objects/recognition/agreement.hpp"
#include "segmenter/objects/recognition/shape_features.hpp"
#include "segmenter/objects/recognition/surface.hpp"
#include "segmenter/objects/recognition/surface_field.hpp"

namespace kintsugi::segmenter {

struct PreparedModel {
  /// @param spacing_m of the surfaces that are compared: the larger of the resolutions of model and
  ///   map
  PreparedModel(const ObjectModel& object, float spacing_m);

  const ObjectModel* object;
  float spacing_m;
  Surface surface_O;
  float radius_m;  ///< half the diagonal of its box
  SurfaceField field;
  ShapeFeatures features;  ///< of the points of surface_O
};

/// The radius within which the shape around a point is described.
float feature_radius_m(float spacing_m);

}  // namespace kintsugi::segmenter

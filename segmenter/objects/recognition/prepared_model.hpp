#pragma once
// An object of the library with what recognition computes of it once.

#include <span>
#include <vector>

#include "segmenter/objects/model/object_model.hpp"
#include "segmenter/objects/recognition/agreement.hpp"
#include "segmenter/objects/recognition/surface.hpp"
#include "segmenter/objects/recognition/surface_field.hpp"
#include "segmenter/objects/recognition/surface_grid.hpp"

namespace kintsugi::segmenter {

struct PreparedModel {
  /// @param spacing_m of the surfaces that are compared: the larger of the resolutions of model and
  ///   map
  PreparedModel(const ObjectModel& object, float spacing_m);

  const ObjectModel* object;
  float spacing_m;
  SurfaceGrid grid_O;
  const Surface& surface_O;  ///< that of `grid_O`
  float radius_m;            ///< half the diagonal of its box
  SurfaceField field;        ///< quicker than `grid_O`, and wrong at edges
};

}  // namespace kintsugi::segmenter

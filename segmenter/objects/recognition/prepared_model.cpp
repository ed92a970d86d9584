#include "segmenter/objects/recognition/prepared_model.hpp"

namespace kintsugi::segmenter {

namespace {

// As far as poses are pulled from where they were found.
constexpr float kReach = 4.0F;  // spacings

}  // namespace

PreparedModel::PreparedModel(const ObjectModel& object_, float spacing)
    : object(&object_),
      spacing_m(spacing),
      grid_O(thinned(object_.points_O, spacing), kSameDistance * spacing),
      surface_O(grid_O.surface()),
      radius_m(radius_of(surface_O)),
      field(surface_O, spacing, kReach * spacing) {}

}  // namespace kintsugi::segmenter

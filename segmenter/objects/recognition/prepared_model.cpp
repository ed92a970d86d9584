#include "segmenter/objects/recognition/prepared_model.hpp"

namespace kintsugi::segmenter {

namespace {

// As far as poses are pulled from where they were found.
constexpr float kReach = 4.0F;  // spacings
// Rusu et al. take several spacings, so that a neighbourhood has tens of points: pi 4^2 are 50.
constexpr float kFeatureRadius = 4.0F;  // spacings

}  // namespace

float feature_radius_m(float spacing_m) { return kFeatureRadius * spacing_m; }

PreparedModel::PreparedModel(const ObjectModel& object_, float spacing)
    : object(&object_),
      spacing_m(spacing),
      surface_O(thinned(object_.points_O, spacing)),
      radius_m(radius_of(surface_O)),
      field(surface_O, spacing, kReach * spacing),
      features(shape_features(surface_O, feature_radius_m(spacing))) {}

}  // namespace kintsugi::segmenter

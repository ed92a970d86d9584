#include "segmenter/objects/recognition/prepared_model.hpp"

namespace kintsugi::segmenter {

namespace {

// As far as poses are pulled from where they were found.
constexpr float kReach = 4.0F;  // spacings
// Descriptors are of every second point along each axis.
constexpr float kDescribedSpacing = 2.0F;  // spacings
// Rusu et al. take several spacings, so that a neighbourhood has tens of points: pi 3^2 are 28.
constexpr float kFeatureRadius = 3.0F;  // spacings of descriptors

}  // namespace

float described_spacing_m(float spacing_m) { return kDescribedSpacing * spacing_m; }

DescribedSurface::DescribedSurface(std::span<const CloudPoint> points, float map_spacing_m)
    : spacing_m(described_spacing_m(map_spacing_m)),
      surface(thinned(points, spacing_m)),
      features(shape_features(surface, kFeatureRadius * spacing_m)) {}

ViewDescriptor DescribedSurface::descriptor() const {
  return view_descriptor(surface, features, spacing_m);
}

std::vector<ViewDescriptor> descriptors_of_views(const DescribedSurface& described) {
  const std::vector<std::vector<std::size_t>> views =
      simulated_views(described.surface, described.spacing_m);
  std::vector<ViewDescriptor> descriptors;
  descriptors.reserve(views.size());
  for (const std::vector<std::size_t>& view : views) {
    descriptors.push_back(view_descriptor(points_of(described.surface, view),
                                          features_of(described.features, view),
                                          described.spacing_m));
  }
  return descriptors;
}

PreparedModel::PreparedModel(const ObjectModel& object_, float spacing)
    : object(&object_),
      spacing_m(spacing),
      surface_O(thinned(object_.points_O, spacing)),
      radius_m(radius_of(surface_O)),
      field(surface_O, spacing, kReach * spacing),
      points_O(surface_O, kSameDistance * spacing),
      described(object_.points_O, spacing) {}

}  // namespace kintsugi::segmenter

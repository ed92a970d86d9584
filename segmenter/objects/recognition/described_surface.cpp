#include "segmenter/objects/recognition/described_surface.hpp"

#include <cstddef>
#include <utility>

namespace kintsugi::segmenter {

namespace {

// Descriptors are of every second point along each axis.
constexpr float kDescribedSpacing = 2.0F;  // spacings
// Rusu et al. take several spacings, so that a neighbourhood has tens of points: pi 3^2 are 28.
constexpr float kFeatureRadius = 3.0F;  // spacings of descriptors

}  // namespace

float described_spacing_m(float spacing_m) { return kDescribedSpacing * spacing_m; }

DescribedSurface::DescribedSurface(Surface surface_, float described_spacing_m)
    : spacing_m(described_spacing_m),
      surface(std::move(surface_)),
      features(shape_features(surface, kFeatureRadius * spacing_m)) {}

std::vector<ViewDescriptor> descriptors_of_views(const DescribedSurface& described) {
  const std::vector<std::vector<std::size_t>> views =
      simulated_views(described.surface, described.spacing_m);
  std::vector<ViewDescriptor> descriptors;
  descriptors.reserve(views.size());
  for (const std::vector<std::size_t>& view : views) {
    descriptors.push_back(view_descriptor(
        size_and_colors(SurfaceMoments(points_of(described.surface, view)), described.spacing_m),
        features_of(described.features, view).rowwise().mean()));
  }
  return descriptors;
}

}  // namespace kintsugi::segmenter

#include "segmenter/objects/changes/changed_points.hpp"

#include <cstddef>
#include <span>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "segmenter/objects/changes/alike_colors.hpp"
#include "segmenter/objects/changes/surface_behind.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {
namespace {

// Nearer than that it is the same surface whatever the normals, which are uncertain at edges.
constexpr double kTouch_vox = 1.0;
// One view may be of a moment when somebody walked by.
constexpr int kLeastThrough = 2;
constexpr int kOutnumber = 3;

/// Same or recoloured, or unknown where the other map has no surface.
PointChange look_up(const CloudPoint& point, const SurfacePoint& color, const MapSide& other,
                    const MapErrors& errors, std::span<const std::uint32_t> indices,
                    std::span<const float> squared_m2) {
  const auto touch_m = static_cast<float>(kTouch_vox * other.voxel_m());
  const auto reach_m = static_cast<float>(errors.distance_m);
  PointChange change = PointChange::kUnknown;
  for (std::size_t k = 0; k < indices.size(); ++k) {
    if (squared_m2[k] > reach_m * reach_m) break;
    const float alike = normal_of(point).dot(normal_of(other.points()[indices[k]]));
    if (squared_m2[k] > touch_m * touch_m && alike < kAlikeNormals) continue;
    if (are_alike_in_color(color, other.colors()[indices[k]], errors.color))
      return PointChange::kSame;
    change = PointChange::kRecolored;
  }
  return change;
}

std::vector<PointChange> look_up_all(const MapSide& map, const MapSide& other,
                                     const MapErrors& errors) {
  const std::span<const CloudPoint> points = map.points();
  std::vector<PointChange> changes(points.size());
  constexpr std::size_t kGrain = 2'000;
  oneapi::tbb::parallel_for(
      oneapi::tbb::blocked_range<std::size_t>(0, points.size(), kGrain), [&](const auto& range) {
        NearestNeighbours::Result result;
        other.tree().find(points.subspan(range.begin(), range.size()), kNeighboursAround, result);
        const auto count = static_cast<std::size_t>(result.count);
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const std::size_t at = (i - range.begin()) * count;
          changes[i] = look_up(points[i], map.colors()[i], other, errors,
                               std::span(result.indices).subspan(at, count),
                               std::span(result.squared_distances).subspan(at, count));
        }
      });
  return changes;
}

}  // namespace

std::vector<PointChange> changes_of(const MapSide& map, const MapSide& other,
                                    const MapErrors& errors) {
  std::vector<PointChange> changes = look_up_all(map, other, errors);
  std::vector<std::size_t> lost;
  std::vector<CloudPoint> lost_points;
  std::vector<Eigen::Vector3f> places;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (changes[i] != PointChange::kUnknown) continue;
    lost.push_back(i);
    lost_points.push_back(map.points()[i]);
    places.push_back(position_of(map.points()[i]));
  }
  const std::vector<Sights> sights = other.space().sights(places);
  const std::vector<bool> is_before_surface =
      have_surface_behind(lost_points, other, errors.distance_m);
  for (std::size_t k = 0; k < lost.size(); ++k) {
    const int measured = is_before_surface[k] ? 0 : sights[k].measured;
    const int through = sights[k].through + sights[k].measured - measured;
    const bool is_free = through >= kLeastThrough && through > kOutnumber * measured;
    if (is_free) changes[lost[k]] = PointChange::kChanged;
  }
  return changes;
}

}  // namespace kintsugi::segmenter

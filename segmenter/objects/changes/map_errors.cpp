#include "segmenter/objects/changes/map_errors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "segmenter/objects/changes/alike_colors.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"

namespace kintsugi::segmenter {
namespace {

// A tenth of a room's surface may have come and another gone: what differs less is the same.
constexpr double kUnchanged = 0.8;
// Of what most surfaces differ by: five standard deviations if errors were normal, but they are
// alike over whole walls.
constexpr double kFactor = 4.0;
constexpr std::size_t kSamples = 20'000;  // tell a share of a fifth to a third of a per cent
constexpr float kReach_m = 0.1F;          // the alignment finds no surface that is farther off

struct Differences {
  std::vector<double> distances_m;
  std::vector<double> colors;
};

/// Of a point from the nearest surface of the other map that faces the same way, and from the
/// colour there that is most like its own.
void add_differences(const CloudPoint& point, const SurfacePoint& color, const MapSide& other,
                     std::span<const std::uint32_t> indices, std::span<const float> squared_m2,
                     Differences& differences) {
  bool is_first = true;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < indices.size() && squared_m2[k] <= kReach_m * kReach_m; ++k) {
    const CloudPoint& there = other.points()[indices[k]];
    const Eigen::Vector3f normal = normal_of(there);
    if (normal.dot(normal_of(point)) < kAlikeNormals) continue;
    if (is_first) {
      differences.distances_m.push_back(
          std::abs(normal.dot(position_of(point) - position_of(there))));
    }
    is_first = false;
    const SurfacePoint& its_color = other.colors()[indices[k]];
    if (color.has_color && its_color.has_color) {
      least = std::min<double>(least, color_distance(color, its_color));
    }
  }
  if (std::isfinite(least)) differences.colors.push_back(least);
}

/// What most of them are below; 0 where there are none.
double most_are_below(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(kUnchanged * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

}  // namespace

MapErrors errors_of(const MapSide& before, const MapSide& after) {
  const std::vector<CloudPoint>& points = before.points();
  const std::size_t count = std::min(points.size(), kSamples);
  std::vector<std::size_t> chosen;
  chosen.reserve(count);
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(i * points.size() / count);
  NearestNeighbours::Result nearest;
  const std::vector<CloudPoint> samples = before.points_at(chosen);
  after.tree().find(samples, kNeighboursAround, nearest);
  const auto neighbours = static_cast<std::size_t>(nearest.count);
  Differences differences;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = i * neighbours;
    add_differences(samples[i], before.colors()[chosen[i]], after,
                    std::span(nearest.indices).subspan(at, neighbours),
                    std::span(nearest.squared_distances).subspan(at, neighbours), differences);
  }
  const double distance_m = kFactor * most_are_below(differences.distances_m);
  const double color = kFactor * most_are_below(differences.colors);
  return {.distance_m = std::max(kLeastError_vox * before.voxel_m(), distance_m),
          .color = std::max(kSameColor, static_cast<float>(color))};
}

}  // namespace kintsugi::segmenter

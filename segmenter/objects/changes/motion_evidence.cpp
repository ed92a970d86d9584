#include "segmenter/objects/changes/motion_evidence.hpp"

#include <algorithm>
#include <vector>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/objects/changes/alike_colors.hpp"
#include "segmenter/objects/changes/map_errors.hpp"
#include "segmenter/objects/changes/surface_behind.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::size_t kSamples = 400;  // a share of a half is known to 5 %
constexpr int kNeighbours = 6;
constexpr float kAlike = 0.7F;  // cosine between normals: 45 degrees
// Two samplings of one surface lie half a voxel apart on each side, and the motion is as exact.
constexpr double kReach_vox = 1.5;

enum class Finding : std::uint8_t { kFound, kEdge, kOther, kNothing };

Finding look_at(const MapSide& map, const CloudPoint& point, const SurfacePoint& color,
                std::span<const std::uint32_t> indices, std::span<const float> squared_m2,
                std::span<const std::size_t> counterpart) {
  const auto reach_m = static_cast<float>(kReach_vox * map.voxel_m());
  const auto counts = [counterpart](std::size_t i) {
    return counterpart.empty() || std::ranges::binary_search(counterpart, i);
  };
  bool is_near = false;
  bool is_on_another = false;
  bool is_facing = false;
  for (std::size_t k = 0; k < indices.size() && squared_m2[k] <= reach_m * reach_m; ++k) {
    is_near = true;
    if (normal_of(point).dot(normal_of(map.points()[indices[k]])) < kAlike) continue;
    is_facing = true;
    if (!are_alike_in_color(color, map.colors()[indices[k]])) continue;
    if (counts(indices[k])) return Finding::kFound;
    is_on_another = true;
  }
  if (is_facing && !is_on_another) return Finding::kOther;
  return is_near ? Finding::kEdge : Finding::kNothing;
}

}  // namespace

Evidence evidence_of(const MapSide& from, std::span<const std::size_t> points, const Pose& X,
                     const MapSide& map, std::span<const std::size_t> counterpart) {
  const std::size_t count = std::min(points.size(), kSamples);
  if (count == 0) return {};
  std::vector<std::size_t> chosen;
  chosen.reserve(count);
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(points[i * points.size() / count]);
  const std::vector<CloudPoint> moved = transformed(X, from.points_at(chosen));
  NearestNeighbours::Result result;
  map.tree().find(moved, kNeighbours, result);
  const auto neighbours = static_cast<std::size_t>(result.count);
  const std::vector<bool> is_before_surface =
      have_surface_behind(moved, map, kLeastError_vox * map.voxel_m());
  Evidence sum;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = i * neighbours;
    switch (look_at(map, moved[i], from.colors()[chosen[i]],
                    std::span(result.indices).subspan(at, neighbours),
                    std::span(result.squared_distances).subspan(at, neighbours), counterpart)) {
      case Finding::kFound:
        sum.found += 1.0;
        break;
      case Finding::kEdge:  // another face of the same edge, or of what touches the thing
        break;
      case Finding::kOther:
        sum.contradicted += 1.0;
        break;
      case Finding::kNothing: {
        const Sights sights = map.space().sights(position_of(moved[i]));
        const bool is_free = is_before_surface[i] ? sights.through + sights.measured > 0
                                                  : sights.through > sights.measured;
        sum.contradicted += is_free ? 1.0 : 0.0;
        break;
      }
    }
  }
  sum.found /= static_cast<double>(count);
  sum.contradicted /= static_cast<double>(count);
  return sum;
}

}  // namespace kintsugi::segmenter

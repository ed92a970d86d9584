#include "segmenter/objects/model/object_views.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

#include "segmenter/views/depth_noise.hpp"

namespace kintsugi::segmenter {
namespace {

/// The depth in the view at the pixel of this point, metres; 0: not measured, or outside.
double depth_at(const MapView& view, const Eigen::Vector3d& p_C) {
  const Intrinsics& camera = view.intrinsics;
  if (!(p_C.z() > 0.0)) return 0.0;
  const double u = std::round(camera.fx * p_C.x() / p_C.z() + camera.cx);
  const double v = std::round(camera.fy * p_C.y() / p_C.z() + camera.cy);
  if (!(u >= 0.0 && v >= 0.0 && u < camera.width && v < camera.height)) return 0.0;
  const std::size_t pixel =
      static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) +
      static_cast<std::size_t>(u);
  return pixel < view.depth_mm.size() ? view.depth_mm[pixel] / 1000.0 : 0.0;
}

/// Of about so many points each view is asked; a tenth of them is enough to have seen the object,
/// and is more than what lies before or behind it by chance.
constexpr std::size_t kSamples = 200;
constexpr std::size_t kSeen = kSamples / 10;

bool has_seen(const MapView& view, std::span<const CloudPoint> points_O, const Pose& X_WO,
              float resolution_m) {
  const Pose X_CO = view.X_WC.inverse() * X_WO;
  const std::size_t step = std::max<std::size_t>(1, points_O.size() / kSamples);
  std::size_t asked = 0;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < points_O.size(); i += step, ++asked) {
    const CloudPoint& p = points_O[i];
    const Eigen::Vector3d p_C = X_CO * Eigen::Vector3d(p.x, p.y, p.z);
    const Eigen::Vector3d n_C = X_CO.linear() * Eigen::Vector3d(p.nx, p.ny, p.nz);
    if (n_C.dot(p_C) >= 0.0) continue;  // faces away
    const double depth_m = depth_at(view, p_C);
    const double tolerance_m = resolution_m + 3.0 * depth_sigma_m(p_C.z());
    if (depth_m > 0.0 && std::abs(depth_m - p_C.z()) <= tolerance_m) ++seen;
  }
  return seen > 0 && seen >= std::min(kSeen, asked / 10);
}

}  // namespace

void merge_directions(std::vector<Eigen::Vector3f>& directions,
                      std::span<const Eigen::Vector3f> more) {
  constexpr float kAlike = 0.985F;  // cosine of 10 degrees
  for (const Eigen::Vector3f& direction : more) {
    const bool is_new = std::none_of(
        directions.begin(), directions.end(),
        [&](const Eigen::Vector3f& other) { return direction.dot(other) > kAlike; });
    if (is_new) directions.push_back(direction);
  }
}

std::vector<Eigen::Vector3f> directions_of_views(std::span<const CloudPoint> points_O,
                                                 const Pose& X_WO,
                                                 std::span<const MapView> views,
                                                 float resolution_m) {
  std::vector<Eigen::Vector3f> directions_O;
  for (const MapView& view : views) {
    const Eigen::Vector3d camera_O = X_WO.inverse() * Eigen::Vector3d(view.X_WC.translation());
    if (!(camera_O.norm() > 0.0) || !has_seen(view, points_O, X_WO, resolution_m)) continue;
    const Eigen::Vector3f direction_O = camera_O.normalized().cast<float>();
    merge_directions(directions_O, {&direction_O, 1});
  }
  return directions_O;
}

}  // namespace kintsugi::segmenter

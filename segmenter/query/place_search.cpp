#include "segmenter/query/place_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kintsugi::segmenter {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Eigen::Vector3d position(const CloudPoint& point) { return {point.x, point.y, point.z}; }

/// Calls visit(place, p_W) for each point that belongs to a segment.
template <class Visit>
void for_each_point(const LabelledCloud& cloud, const Visit& visit) {
  for (std::size_t i = 0; i < cloud.segment_ids.size(); ++i) {
    if (cloud.segment_ids[i] != kNoSegment) visit(i, position(cloud.points_W[i]));
  }
}

/// The nearest point of a segment within `radius_m` for which keep(point) holds.
template <class Keep>
std::optional<Hit> nearest_of(const LabelledCloud& cloud, const Eigen::Vector3d& point_W,
                              double radius_m, const Keep& keep) {
  std::optional<std::size_t> nearest;
  double least_m2 = radius_m * radius_m;
  // Most points are far away, which one coordinate tells; float32 rounds by much less than this.
  const Eigen::Vector3f center_W = point_W.cast<float>();
  const float reach_m = static_cast<float>(1.001 * radius_m + 1e-6 * point_W.cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < cloud.segment_ids.size(); ++i) {
    const CloudPoint& point = cloud.points_W[i];
    if (!(std::abs(point.x - center_W.x()) <= reach_m)) continue;
    if (!(std::abs(point.y - center_W.y()) <= reach_m) || cloud.segment_ids[i] == kNoSegment) {
      continue;
    }
    const double distance_m2 = (position(point) - point_W).squaredNorm();
    const bool is_nearer = nearest ? distance_m2 < least_m2 : distance_m2 <= least_m2;
    if (!is_nearer || !keep(point)) continue;
    nearest = i;
    least_m2 = distance_m2;
  }
  if (!nearest) return std::nullopt;
  return Hit{*nearest, std::sqrt(least_m2)};
}

/// The intersection of a ray with the disc of a point.
struct Crossing {
  std::size_t point = 0;
  double t_m = 0.0;         ///< along the ray
  double off_center_m = 0;  ///< distance of the intersection from the point
};

std::optional<Crossing> cross(const Ray& ray, const CloudPoint& point, std::size_t place,
                              double radius_m) {
  const Eigen::Vector3d to_point_W = position(point) - ray.origin_W;
  const double nearest_t_m = to_point_W.dot(ray.direction_W);
  const double squared_distance_m2 = to_point_W.squaredNorm() - nearest_t_m * nearest_t_m;
  if (squared_distance_m2 > radius_m * radius_m) return std::nullopt;  // no disc reaches the ray

  Eigen::Vector3d normal_W(point.nx, point.ny, point.nz);
  if (normal_W.isZero()) normal_W = -ray.direction_W;
  const double slope = normal_W.dot(ray.direction_W);
  if (slope >= 0.0) return std::nullopt;  // seen from behind
  const double t_m = normal_W.dot(to_point_W) / slope;
  const double off_center_m = (t_m * ray.direction_W - to_point_W).norm();
  // Written so that NaN, the result for a normal perpendicular to the ray, fails.
  if (!(t_m >= 0.0 && off_center_m <= radius_m)) return std::nullopt;
  return Crossing{place, t_m, off_center_m};
}

std::optional<Hit> first_disc(const LabelledCloud& cloud, const Ray& ray, double radius_m) {
  std::vector<Crossing> crossings;
  double first_t_m = kInfinity;
  for_each_point(cloud, [&](std::size_t i, const Eigen::Vector3d& /*p_W*/) {
    if (const auto crossing = cross(ray, cloud.points_W[i], i, radius_m)) {
      crossings.push_back(*crossing);
      first_t_m = std::min(first_t_m, crossing->t_m);
    }
  });
  std::optional<Hit> hit;
  double off_center_m = kInfinity;
  for (const Crossing& crossing : crossings) {
    if (crossing.t_m <= first_t_m + radius_m && crossing.off_center_m < off_center_m) {
      off_center_m = crossing.off_center_m;
      hit = Hit{crossing.point, crossing.t_m};
    }
  }
  return hit;
}

}  // namespace

std::optional<Hit> nearest_point(const LabelledCloud& cloud, const Eigen::Vector3d& point_W,
                                 double radius_m) {
  return nearest_of(cloud, point_W, radius_m, [](const CloudPoint&) { return true; });
}

std::optional<Hit> measured_surface(const LabelledCloud& cloud, const MeasuredPoint& measured,
                                    double radius_m) {
  const Eigen::Vector3d& direction_W = measured.ray.direction_W;
  auto hit =
      nearest_of(cloud, measured.point_W(), radius_m, [&direction_W](const CloudPoint& point) {
        return Eigen::Vector3d(point.nx, point.ny, point.nz).dot(direction_W) <= 0.0;
      });
  if (hit) {
    const Eigen::Vector3d to_point_W = position(cloud.points_W[hit->point]) - measured.ray.origin_W;
    hit->distance_m = std::max(0.0, to_point_W.dot(direction_W));
  }
  return hit;
}

std::optional<Hit> visible_point(const LabelledCloud& cloud, const Ray& ray, double radius_m) {
  const auto hit = first_disc(cloud, ray, radius_m / 2);
  return hit ? hit : first_disc(cloud, ray, radius_m);
}

std::vector<std::uint32_t> segments_in_box(const LabelledCloud& cloud,
                                           const Eigen::AlignedBox3d& box_W) {
  std::vector<std::uint32_t> ids;
  for_each_point(cloud, [&](std::size_t i, const Eigen::Vector3d& p_W) {
    // Consecutive points are mostly of one segment, so this keeps the list short.
    const std::uint32_t id = cloud.segment_ids[i];
    if (box_W.contains(p_W) && (ids.empty() || ids.back() != id)) ids.push_back(id);
  });
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

}  // namespace kintsugi::segmenter

#pragma once
// Finds the points and segments at a place in the map.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "segmenter/description/labelled_cloud.hpp"

namespace kintsugi::segmenter {

/// A point that a search found.
struct Hit {
  std::size_t point = 0;    ///< index in the cloud
  double distance_m = 0.0;  ///< from the given point, or along the ray
};

/// A ray from `origin_W` along `direction_W`, which is a unit vector.
struct Ray {
  Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_W = Eigen::Vector3d::UnitZ();
};

/// A point that a camera measures.
struct MeasuredPoint {
  Ray ray;                  ///< from the camera's centre through the point
  double distance_m = 0.0;  ///< along the ray, > 0

  Eigen::Vector3d point_W() const { return ray.origin_W + distance_m * ray.direction_W; }
};

/// The point of a segment that is nearest to `point_W` and at most `radius_m` away; of equally near
/// ones the first in the cloud.
std::optional<Hit> nearest_point(const LabelledCloud& cloud, const Eigen::Vector3d& point_W,
                                 double radius_m);

/// The point of a segment on the surface that a camera measures: the one nearest to the measured
/// point, at most `radius_m` away, of those whose normal does not point away from the camera (the
/// other side of a thin thing is near, but not in view) or that have none. Hit::distance_m is along
/// the ray.
std::optional<Hit> measured_surface(const LabelledCloud& cloud, const MeasuredPoint& measured,
                                    double radius_m);

/// The point of a segment that a camera at the ray's origin sees along it.
///
/// Each point stands for a disc in its tangent plane, which is visible only from the side of its
/// normal; a point without a normal faces the ray. The first disc that the ray meets gives the
/// distance of the surface. Of the discs that the ray meets up to one disc radius behind it, the
/// result is the one whose centre is nearest to the intersection; of equally near ones the first in
/// the cloud. Discs of `radius_m` / 2 are tried first, then discs of `radius_m` if the ray meets
/// none: so an object does not look wider than it is in front of something else.
std::optional<Hit> visible_point(const LabelledCloud& cloud, const Ray& ray, double radius_m);

/// The segments with a point in the box or on its faces, by ascending id.
std::vector<std::uint32_t> segments_in_box(const LabelledCloud& cloud,
                                           const Eigen::AlignedBox3d& box_W);

}  // namespace kintsugi::segmenter

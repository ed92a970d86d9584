#pragma once
// Which segments are at a place of the map.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "segmenter/description/labelled_cloud.hpp"

namespace kintsugi::segmenter {

/// A point of the map that a query found.
struct Hit {
  std::size_t point = 0;    ///< place in the cloud
  double distance_m = 0.0;  ///< from the point that was asked for; or along the ray
};

/// A ray from `origin_W` along `direction_W`, which is a unit vector.
struct Ray {
  Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_W = Eigen::Vector3d::UnitZ();
};

/// The point of a segment that is nearest to `point_W`, not farther than `radius_m`; of equally
/// near ones the first in the cloud.
std::optional<Hit> nearest_point(const LabelledCloud& cloud, const Eigen::Vector3d& point_W,
                                 double radius_m);

/// The point of a segment that a camera at the ray's origin sees along it.
///
/// Each point stands for a disc in its tangent plane that is seen from the side of its normal only;
/// a point without a normal faces the ray. The first disc that the ray meets decides how far the
/// surface is; of those met within another radius behind it, the one whose centre is nearest to
/// where the ray meets it is the answer (of equally near ones the first in the cloud). Discs of
/// `radius_m` / 2 are tried first, and those of `radius_m` where the ray passes between all of
/// them: so an object is not seen wider than it is where there is something behind it.
std::optional<Hit> visible_point(const LabelledCloud& cloud, const Ray& ray, double radius_m);

/// The segments with a point in the box or on its faces, by ascending id.
std::vector<std::uint32_t> segments_in_box(const LabelledCloud& cloud,
                                           const Eigen::AlignedBox3d& box_W);

}  // namespace kintsugi::segmenter

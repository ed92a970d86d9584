#include "segmenter/core/points/transformed_points.hpp"

#include <Eigen/Geometry>

namespace kintsugi::segmenter {

CloudPoint transformed(const CloudPoint& point_A, const Pose& X_BA) {
  CloudPoint point_B = point_A;
  const Eigen::Vector3f p = (X_BA * Eigen::Vector3d(point_A.x, point_A.y, point_A.z)).cast<float>();
  const Eigen::Vector3f n =
      (X_BA.linear() * Eigen::Vector3d(point_A.nx, point_A.ny, point_A.nz)).cast<float>();
  point_B.x = p.x();
  point_B.y = p.y();
  point_B.z = p.z();
  point_B.nx = n.x();
  point_B.ny = n.y();
  point_B.nz = n.z();
  return point_B;
}

std::vector<CloudPoint> transformed(const Pose& X_BA, std::span<const CloudPoint> points_A) {
  std::vector<CloudPoint> points_B;
  points_B.reserve(points_A.size());
  for (const CloudPoint& point_A : points_A) points_B.push_back(transformed(point_A, X_BA));
  return points_B;
}

}  // namespace kintsugi::segmenter

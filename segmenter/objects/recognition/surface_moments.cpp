#include "segmenter/objects/recognition/surface_moments.hpp"

namespace kintsugi::segmenter {

SurfaceMoments::SurfaceMoments(const Surface& surface)
    : points(static_cast<double>(surface.size())) {
  for (const SurfacePoint& point : surface) {
    const Eigen::Vector3d p = point.position.cast<double>();
    const Eigen::Vector3d n = point.normal.cast<double>();
    positions += p;
    squared_positions += p * p.transpose();
    squared_normals += n * n.transpose();
    if (!point.has_color) continue;
    const Eigen::Vector3d lab = point.lab.cast<double>();
    colored_points += 1;
    labs += lab;
    squared_labs += lab.cwiseAbs2();
  }
}

SurfaceMoments& SurfaceMoments::operator+=(const SurfaceMoments& other) {
  points += other.points;
  positions += other.positions;
  squared_positions += other.squared_positions;
  squared_normals += other.squared_normals;
  colored_points += other.colored_points;
  labs += other.labs;
  squared_labs += other.squared_labs;
  return *this;
}

Eigen::Matrix3d SurfaceMoments::covariance_m2() const {
  const Eigen::Vector3d mean = positions / points;
  return squared_positions / points - mean * mean.transpose();
}

Eigen::Vector3d SurfaceMoments::mean_lab() const {
  return colored_points > 0 ? Eigen::Vector3d(labs / colored_points) : labs;
}

Eigen::Vector3d SurfaceMoments::lab_variance() const {
  if (colored_points == 0) return squared_labs;
  return (squared_labs / colored_points - mean_lab().cwiseAbs2()).cwiseMax(0.0);
}

}  // namespace kintsugi::segmenter

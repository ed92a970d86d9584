#pragma once
// Sums over the points of a surface, from which follow its size, its colours and whether it is
// flat: those of several surfaces add up.

#include <Eigen/Core>

#include "segmenter/objects/recognition/surface.hpp"

namespace kintsugi::segmenter {

struct SurfaceMoments {
  double points = 0;
  Eigen::Vector3d positions = Eigen::Vector3d::Zero();          ///< metres
  Eigen::Matrix3d squared_positions = Eigen::Matrix3d::Zero();  ///< p p^T
  Eigen::Matrix3d squared_normals = Eigen::Matrix3d::Zero();    ///< n n^T
  double colored_points = 0;
  Eigen::Vector3d labs = Eigen::Vector3d::Zero();          ///< CIELAB, of these
  Eigen::Vector3d squared_labs = Eigen::Vector3d::Zero();  ///< by element

  SurfaceMoments() = default;
  explicit SurfaceMoments(const Surface& surface);
  SurfaceMoments& operator+=(const SurfaceMoments& other);

  [[nodiscard]] bool empty() const { return points == 0; }
  /// Of the positions, square metres. There must be points.
  [[nodiscard]] Eigen::Matrix3d covariance_m2() const;
  /// 0 without colours, as the next one.
  [[nodiscard]] Eigen::Vector3d mean_lab() const;
  /// Of each element.
  [[nodiscard]] Eigen::Vector3d lab_variance() const;
};

}  // namespace kintsugi::segmenter

#include "segmenter/description/segment_shape.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "segmenter/description/minimal_rectangle.hpp"

namespace kintsugi::segmenter {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Vector3d position(const CloudPoint& p) { return {p.x, p.y, p.z}; }

// Sums are integers in fixed point, so that they do not depend on the order of points. A coordinate
// is below 2^20 m (admission.hpp), so below 2^45 units; 2^32 products of two fit in 128 bits.
__extension__ using WideInteger = __int128;
constexpr double kUnitsPerMetre = 16777216.0;  // 2^24: 60 nm, half a float32 step at 1 m

std::array<std::int64_t, 3> in_units(const CloudPoint& p) {
  const auto units = [](float value) {
    return std::llround(static_cast<double>(value) * kUnitsPerMetre);
  };
  return {units(p.x), units(p.y), units(p.z)};
}

std::array<std::int64_t, 3> centroid_in_units(std::span<const CloudPoint> points_W) {
  std::array<WideInteger, 3> sum{};
  for (const CloudPoint& p : points_W) {
    const auto units = in_units(p);
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += units[axis];
  }
  const auto mean = [&](std::size_t axis) {
    return static_cast<std::int64_t>(sum[axis] / static_cast<WideInteger>(points_W.size()));
  };
  return {mean(0), mean(1), mean(2)};
}

/// Columns: the principal axes, by ascending variance.
Matrix3d principal_axes(std::span<const CloudPoint> points_W,
                        const std::array<std::int64_t, 3>& centroid_W) {
  std::array<std::array<WideInteger, 3>, 3> sum{};  // below the diagonal; rows, columns
  for (const CloudPoint& p : points_W) {
    std::array<std::int64_t, 3> d = in_units(p);
    for (std::size_t axis = 0; axis < 3; ++axis) d[axis] -= centroid_W[axis];
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column <= row; ++column) {
        sum[row][column] += static_cast<WideInteger>(d[row]) * d[column];
      }
    }
  }
  Matrix3d scatter;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column <= row; ++column) {
      const auto at_row = static_cast<Eigen::Index>(row);
      const auto at_column = static_cast<Eigen::Index>(column);
      scatter(at_row, at_column) = static_cast<double>(sum[row][column]);
      scatter(at_column, at_row) = scatter(at_row, at_column);
    }
  }
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(scatter).eigenvectors();
}

/// `v` or -v: the one whose first non-zero component is positive.
Vector3d with_positive_start(const Vector3d& v) {
  for (const double component : v) {
    if (component != 0.0) return component > 0.0 ? v : Vector3d(-v);
  }
  return v;
}

Vector3d with_positive_largest(const Vector3d& v) {
  Eigen::Index largest = 0;
  v.cwiseAbs().maxCoeff(&largest);
  return v[largest] < 0.0 ? Vector3d(-v) : v;
}

/// `normal_W` or its opposite.
Vector3d facing_free_space(const Vector3d& normal_W, std::span<const CloudPoint> points_W) {
  constexpr double kUnits = 1073741824.0;  // 2^30: sums of 2^32 unit normals fit
  std::array<std::int64_t, 3> sum{};
  for (const CloudPoint& p : points_W) {
    const std::array<float, 3> normal{p.nx, p.ny, p.nz};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sum[axis] += std::llround(static_cast<double>(normal[axis]) * kUnits);
    }
  }
  const Vector3d sum_W(static_cast<double>(sum[0]), static_cast<double>(sum[1]),
                       static_cast<double>(sum[2]));
  // Below this cosine, rounding decides the side.
  const double min_cosine = 1e-6 * kUnits * static_cast<double>(points_W.size());
  const double cosine = normal_W.dot(sum_W);
  if (std::abs(cosine) < min_cosine) return with_positive_start(normal_W);
  return cosine < 0.0 ? Vector3d(-normal_W) : normal_W;
}

struct Interval {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
};

/// Sets rms_m and inlier_share of `plane`. Returns the range of the points' heights above it.
Interval measure_plane(std::span<const CloudPoint> points_W, float resolution_m, PlaneFit& plane) {
  Interval heights;
  WideInteger sum_of_squares = 0;
  std::size_t num_inliers = 0;
  for (const CloudPoint& p : points_W) {
    const double height_m = plane.normal_W.dot(position(p)) - plane.offset_m;
    heights = {std::min(heights.min, height_m), std::max(heights.max, height_m)};
    const std::int64_t height = std::llround(height_m * kUnitsPerMetre);
    sum_of_squares += static_cast<WideInteger>(height) * height;
    if (std::abs(height_m) <= resolution_m) ++num_inliers;
  }
  const auto count = static_cast<double>(points_W.size());
  plane.rms_m = std::sqrt(static_cast<double>(sum_of_squares) / count) / kUnitsPerMetre;
  plane.inlier_share = static_cast<double>(num_inliers) / count;
  return heights;
}

/// The box whose base is the smallest rectangle around the points' projections onto the plane.
OrientedBox box_on_plane(std::span<const CloudPoint> points_W, const PlaneFit& plane,
                         const Interval& heights, const Vector3d& centroid_W) {
  const Vector3d u_W = plane.normal_W.unitOrthogonal();
  const Vector3d v_W = plane.normal_W.cross(u_W);
  std::vector<Vector2d> projections;
  projections.reserve(points_W.size());
  for (const CloudPoint& p : points_W) {
    const Vector3d d = position(p) - centroid_W;
    projections.emplace_back(u_W.dot(d), v_W.dot(d));
  }
  const Rectangle rectangle = minimal_rectangle(std::move(projections));
  Matrix3d R_WB;
  R_WB.col(0) =
      with_positive_largest(rectangle.axis.x() * u_W + rectangle.axis.y() * v_W).normalized();
  R_WB.col(2) = plane.normal_W;
  R_WB.col(1) = R_WB.col(2).cross(R_WB.col(0));
  OrientedBox box;
  box.X_WB.linear() = R_WB;
  box.X_WB.translation() = centroid_W + rectangle.center.x() * u_W + rectangle.center.y() * v_W +
                           0.5 * (heights.min + heights.max) * plane.normal_W;
  box.size_m << rectangle.size, heights.max - heights.min;
  return box;
}

}  // namespace

SegmentShape shape_of(std::span<const CloudPoint> points_W, float resolution_m) {
  assert(!points_W.empty());
  const auto centroid = centroid_in_units(points_W);
  const Vector3d centroid_W =
      Vector3d(static_cast<double>(centroid[0]), static_cast<double>(centroid[1]),
               static_cast<double>(centroid[2])) /
      kUnitsPerMetre;
  SegmentShape shape;
  PlaneFit& plane = shape.plane;
  plane.normal_W =
      facing_free_space(principal_axes(points_W, centroid).col(0), points_W).normalized();
  plane.offset_m = plane.normal_W.dot(centroid_W);
  const Interval heights = measure_plane(points_W, resolution_m, plane);
  shape.box = box_on_plane(points_W, plane, heights, centroid_W);
  shape.is_planar =
      plane.inlier_share >= kPlanarShare && shape.box.size_m.y() >= kPlanarEdge_vox * resolution_m;
  return shape;
}

}  // namespace kintsugi::segmenter

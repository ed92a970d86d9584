#pragma once
// The box and the plane of points.

#include <Eigen/Core>
#include <span>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// A box that stands as its content does. Frame B: its origin is the centre of the box, its axes
/// are the edges.
struct OrientedBox {
  Pose X_WB = Pose::Identity();
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< full lengths along B's x, y and z
};

/// The plane that is nearest to points in the sense of least squares: normal . p = offset.
struct PlaneFit {
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< unit
  double offset_m = 0.0;      ///< of the plane from W's origin, along the normal
  double rms_m = 0.0;         ///< root of the mean squared distance of the points
  double inlier_share = 0.0;  ///< of the points: at most one voxel from the plane
};

struct SegmentShape {
  OrientedBox box;
  PlaneFit plane;
  /// kPlanarShare of the points are at most a voxel from the plane, and they are no line: the plane
  /// is determined by kPlanarEdge_vox voxels at least in every direction.
  bool is_planar = false;
};

inline constexpr double kPlanarShare = 0.9;
inline constexpr double kPlanarEdge_vox = 5.0;

/// The shape of at least one point; all must be admissible (admission.hpp), but for
/// normals, which may be zero.
///
/// The plane is the one through the centroid, normal to the direction of least variance (principal
/// component analysis). Its normal looks to the side where the mean of the points' normals does;
/// when that is in the plane, to where its first component that is not zero is positive.
///
/// The box has that normal for B's z, and is the one of least volume among those: around the
/// rectangle of least area, in the plane, that holds the points' projections. B's x is its longer
/// edge, towards where its largest component is positive.
///
/// Points on a line, or a single one, determine no plane: the normal is any that is perpendicular.
///
/// @param resolution_m voxel size, > 0
/// The result does not depend on the order of the points.
SegmentShape shape_of(std::span<const CloudPoint> points_W, float resolution_m);

}  // namespace kintsugi::segmenter

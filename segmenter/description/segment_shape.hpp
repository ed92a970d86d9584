#pragma once
// The oriented box and the plane of a segment.

#include <Eigen/Core>
#include <span>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// A box in any orientation. Frame B has its origin in the centre of the box and its axes along the
/// edges.
struct OrientedBox {
  Pose X_WB = Pose::Identity();
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< full lengths along B's x, y and z
};

/// The least-squares plane of points: normal . p = offset.
struct PlaneFit {
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< unit
  double offset_m = 0.0;      ///< distance of the plane from W's origin, along the normal
  double rms_m = 0.0;         ///< root of the mean squared distance of the points
  double inlier_share = 0.0;  ///< share of the points that are at most one voxel from the plane
};

struct SegmentShape {
  OrientedBox box;
  PlaneFit plane;
  /// At least kPlanarShare of the points are at most a voxel from the plane, and the box is at
  /// least kPlanarEdge_vox voxels wide: points on a line do not determine a plane.
  bool is_planar = false;
};

inline constexpr double kPlanarShare = 0.9;
inline constexpr double kPlanarEdge_vox = 5.0;

/// The shape of at least one point. All must be admissible (admission.hpp), except that normals may
/// be zero. The result does not depend on the order of the points.
///
/// The plane goes through the centroid; its normal is the direction of least variance (principal
/// component analysis). The normal points to the side of the mean of the points' normals; if that
/// lies in the plane, its first component that is not zero is positive. Points on a line, or a
/// single point, determine no plane: the normal is then any perpendicular direction.
///
/// The box has that normal as B's z. Among those boxes it is the smallest one: its base is the
/// rectangle of least area, in the plane, that contains the projections of the points. B's x is the
/// longer edge, with its largest component positive.
///
/// @param resolution_m voxel size, > 0
SegmentShape shape_of(std::span<const CloudPoint> points_W, float resolution_m);

}  // namespace kintsugi::segmenter

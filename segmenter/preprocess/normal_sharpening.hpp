#pragma once
// Gives the points at an edge the normal of one of the two surfaces that meet there.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/preprocess/normal_orientation.hpp"

namespace kintsugi::segmenter {

/// The plane through the neighbourhood of a point, whose normal is that of the point.
struct LocalPlane {
  Eigen::Vector3f mean_W = Eigen::Vector3f::Zero();
  float thickness_m = 0.0F;  ///< standard deviation across the plane
  float width_m = 0.0F;      ///< standard deviation along its narrower side; 0: there is no plane
};

/// Within a neighbourhood's radius of an edge, the plane through a point's neighbourhood leans from
/// one surface to the other, the more the nearer the edge: rows of points that agree among each
/// other and with nobody else. A point takes the normal of a plane near by instead if that lies on
/// the points it stands for much better (relative thickness at most half of the point's own) and
/// the point lies on it, too. On a surface without edges planes are about equally thick, and every
/// point keeps its normal. What a point takes passes on along `graph`, `num_rounds` times.
///
/// @param points_W with consistently oriented normals
/// @param planes one for each point
void sharpen_normals(std::span<CloudPoint> points_W, std::span<const LocalPlane> planes,
                     const NeighbourGraph& graph, int num_rounds);

}  // namespace kintsugi::segmenter

#pragma once

#include <Eigen/Core>
#include <vector>

namespace kintsugi::segmenter {

/// A rectangle in the plane, in any orientation.
struct Rectangle {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  ///< unit, along the longer edge
  Eigen::Vector2d size = Eigen::Vector2d::Zero();   ///< full lengths: along `axis`, then across
};

/// The rectangle of least area that contains all points; there must be at least one. For points on
/// a line it has no width. One of its edges lies on an edge of the convex hull (Freeman and Shapira
/// 1975), so only these directions are tried.
Rectangle minimal_rectangle(std::vector<Eigen::Vector2d> points);

}  // namespace kintsugi::segmenter

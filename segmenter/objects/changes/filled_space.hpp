#pragma once
// The room that a thing takes.

#include <span>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// The convex hull of a thing's surface, as planes of 49 evenly spread directions bound it, among
/// them the vertical and horizontal ones: most things stand upright.
class FilledSpace {
 public:
  /// @param up unit vector
  FilledSpace(std::span<const CloudPoint> surface, const Eigen::Vector3d& up);

  /// Whether the place is at least `margin_m` inside; a negative margin is one outside.
  [[nodiscard]] bool contains(const Eigen::Vector3f& p, float margin_m) const;

 private:
  struct Bounds {
    float least;
    float most;
  };
  Eigen::Matrix3f R_UW_;
  std::vector<Bounds> bounds_;  // along each direction, of U
};

}  // namespace kintsugi::segmenter

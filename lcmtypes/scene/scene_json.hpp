#pragma once
// The texts that the page in a browser reads, with the same keys in every program.

#include <Eigen/Core>

#include <nlohmann/json.hpp>

#include "lcmtypes/scene/tile.hpp"
#include "lcmtypes/segment_messages.hpp"

namespace kintsugi::scene {

/// The plane through the points of a segment: normal . p = offset.
struct SegmentPlane {
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();  ///< unit; zero: no plane is known
  double offset_m = 0.0;
  double rms_m = 0.0;      ///< of the distances of its points
  bool is_planar = false;  ///< its points lie in the plane

  bool operator==(const SegmentPlane&) const = default;
};

/// What the page must know of a tile before it asks for its points, as an array: id, revisions of
/// points and labels, count, part, resolution, least corner and size of the box (P, metres), then
/// X_WP as translation and quaternion x y z w.
nlohmann::json tile_json(const Tile& tile);

/// Statistics of a segment (as in every file), "planar" and "plane".
nlohmann::ordered_json segment_json(const SegmentStatistics& statistics, const SegmentPlane& plane);

}  // namespace kintsugi::scene

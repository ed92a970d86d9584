#pragma once
// What recognition needs to know of a map.

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/views/observed_space.hpp"

namespace kintsugi::segmenter {

/// The map around a place.
struct MapExcerpt {
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> segment_ids;  ///< of each point
};

/// Valid as long as the map does not change.
struct MapAccess {
  float resolution_m = 0.0F;
  Eigen::Vector3d up_W = -Eigen::Vector3d::UnitY();
  const ObservedSpace* observed = nullptr;  ///< nullptr: nothing is known of what the camera saw
  /// All points in a box.
  std::function<MapExcerpt(const Eigen::AlignedBox3f& box_W)> points_in;
  /// All points of segments, whose ids are given in ascending order.
  std::function<std::vector<CloudPoint>(const std::vector<std::uint32_t>& ids)> points_of;
  /// How many points a segment has.
  std::function<std::int64_t(std::uint32_t id)> num_points;
};

}  // namespace kintsugi::segmenter

#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::viewer {

/// Points of one slice that are drawn or culled together. Refers to the points and labels of a
/// MapSlice: valid until the map changes.
struct PointChunk {
  /// Points in a chunk, fewer only in the last one of a slice. A power of two, so that the number
  /// of a point in a picture splits into chunk and index by shifting.
  static constexpr std::size_t kMaxPoints = 4096;

  std::span<const CloudPoint> points_W;
  std::span<const std::uint32_t> labels;  ///< segment id of each point; kNoSegment: none yet
  Eigen::AlignedBox3f box_W;              ///< of the finite points, metres
  float resolution_m = 0.0F;              ///< voxel size of the volume the points come from
};

/// Bounding boxes of each PointChunk::kMaxPoints consecutive points, without points that are not
/// finite.
std::vector<Eigen::AlignedBox3f> chunk_boxes_of(std::span<const CloudPoint> points_W);

}  // namespace kintsugi::viewer

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// A point before and after, by their positions in the two lists.
struct PointPair {
  std::uint32_t before = 0;
  std::uint32_t after = 0;

  bool operator==(const PointPair&) const = default;
};

/// Pairs the points of two revisions of a surface that has at most one point in each voxel: points
/// of one voxel, and then, of those that are left, points on both sides of a voxel's face, since a
/// point beside a face crosses it with the slightest motion. Each point is in one pair at most. The
/// pairs do not depend on the order of the points, except where a voxel has several.
///
/// By ascending `after`. Takes n log n.
std::vector<PointPair> pair_by_voxel(std::span<const CloudPoint> before_W,
                                     std::span<const CloudPoint> after_W, double voxel_m);

}  // namespace kintsugi::segmenter

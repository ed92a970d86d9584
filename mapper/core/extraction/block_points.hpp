#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapper/core/extraction/padded_block.hpp"

namespace kintsugi::mapper {

/// Between which neighbouring voxels there is surface.
///
/// Where the camera sees past an object's outline, free space begins beside what is taken to be
/// behind the outline: a wall that is not there. It shows in the distance, which rises along it
/// from one voxel to the next by up to the whole truncation band; on a surface it rises by a voxel
/// over the cosine of the angle at which the surface was seen.
struct CrossingRule {
  int weight_threshold = 0;  ///< both voxels were seen more often than this
  int max_step_raw = 0;      ///< their distances differ by no more than this

  /// `max_step_vox` is in voxels.
  CrossingRule(int weight_threshold, double max_step_vox, const DetachedBlocks& blocks);
};

/// The surface points of a block, at most one in a voxel, in the order of voxels.
class BlockPoints {
 public:
  struct Point {
    Eigen::Vector3f offset_vox;  ///< from the centre of its voxel
    Eigen::Vector3f normal_W;    ///< unit, from the gradient at the point
  };

  BlockPoints() = default;
  BlockPoints(const PaddedBlock& block, const CrossingRule& rule);

  bool empty() const { return points_.empty(); }
  const std::vector<Point>& points() const { return points_; }

  /// Which voxels of a row have a point, lowest bit first; rows are numbered z * 8 + y.
  unsigned row_mask(int row) const { return row_masks_[row]; }
  /// The row's first point.
  const Point* row_points(int row) const { return points_.data() + row_starts_[row]; }

 private:
  std::vector<Point> points_;
  static constexpr std::size_t kNumRows = std::size_t{kBlockSide} * kBlockSide;
  std::array<std::uint8_t, kNumRows> row_masks_{};
  std::array<std::uint16_t, kNumRows> row_starts_{};
};

/// Whether a block has voxels seen more often than the threshold on the surface's two sides.
struct ObservedSides {
  bool free_space = false;
  bool behind = false;
};
ObservedSides observed_sides(const VoxelBlock& block, int weight_threshold);

}  // namespace kintsugi::mapper

#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "mapper/core/padded_block.hpp"

namespace kintsugi::mapper {

/// The surface points of a block, at most one in a voxel, in the order of voxels.
class BlockPoints {
 public:
  struct Point {
    Eigen::Vector3f offset_vox;  ///< from the centre of its voxel
    Eigen::Vector3f normal_W;    ///< unit, from the gradient at the point
  };

  BlockPoints() = default;
  /// Crossings between voxels seen more often than the threshold.
  BlockPoints(const PaddedBlock& block, int weight_threshold);

  bool empty() const { return points_.empty(); }
  const std::vector<Point>& points() const { return points_; }

  /// Which voxels of a row have a point, lowest bit first; rows are numbered z * 8 + y.
  unsigned row_mask(int row) const { return row_masks_[row]; }
  /// The row's first point.
  const Point* row_points(int row) const { return points_.data() + row_starts_[row]; }

 private:
  std::vector<Point> points_;
  std::array<std::uint8_t, kBlockSide * kBlockSide> row_masks_{};
  std::array<std::uint16_t, kBlockSide * kBlockSide> row_starts_{};
};

/// Whether a block has voxels seen more often than the threshold on the surface's two sides.
struct ObservedSides {
  bool free_space = false;
  bool behind = false;
};
ObservedSides observed_sides(const VoxelBlock& block, int weight_threshold);

}  // namespace kintsugi::mapper

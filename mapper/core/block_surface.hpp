#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "mapper/core/padded_block.hpp"

namespace kintsugi::mapper {

/// The surface points of a block, and those around it that its normals are averaged over.
class BlockSurface {
 public:
  struct Point {
    std::array<std::int8_t, 3> voxel;  ///< x, y, z from the block's first voxel
    Eigen::Vector3f position_vox;      ///< from the block's lower corner
    Eigen::Vector3f normal_W;          ///< unit, from the gradient at the point
  };

  BlockSurface(const PaddedBlock& block, int weight_threshold);

  /// In the order of voxels, z first; also those within two voxels of the block.
  const std::vector<Point>& points() const { return points_; }
  static bool is_in_block(const Point& point);

  /// The mean of the unit normals of the surface within `radius_vox` (at most 2) of a point of the
  /// block, those that face away from its own left out; unit.
  Eigen::Vector3f mean_normal(const Point& point, float radius_vox) const;

 private:
  static constexpr int kReach = 2;
  static constexpr int kSide = kBlockSide + 2 * kReach;
  static constexpr int kNumCells = kSide * kSide * kSide;
  static_assert(PaddedBlock::kPad >= kReach + 2);  // gradients around a point's voxel

  void add_point(const PaddedBlock& block, int x, int y, int z, int weight_threshold);
  static int cell_index(int x, int y, int z) {
    return ((z + kReach) * kSide + (y + kReach)) * kSide + (x + kReach);
  }

  std::vector<Point> points_;
  std::array<std::int16_t, kNumCells> cells_;  ///< index of a voxel's point, or -1
};

}  // namespace kintsugi::mapper

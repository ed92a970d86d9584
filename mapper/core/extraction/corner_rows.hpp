#pragma once

#include <array>
#include <cstddef>

#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper {

/// The voxels at the corners of the cubes that start in a block, 0 .. 8 along each axis.
class CornerRows {
 public:
  /// `octant`: the block and those next to it towards plus x, y and z, x fastest; null: no block.
  CornerRows(const std::array<const VoxelBlock*, 8>& octant, int weight_threshold) {
    static constexpr VoxelBlock kUnobserved{};
    const Voxel threshold = (static_cast<Voxel>(weight_threshold) << 16U) | 0xFFFFU;
    for (int z = 0; z < kCornerSide; ++z) {
      for (int y = 0; y < kCornerSide; ++y) {
        Row& row = rows_[z * kCornerSide + y];
        for (int x = 0; x < kCornerSide; ++x) {
          const int block = x / kBlockSide + 2 * (y / kBlockSide) + 4 * (z / kBlockSide);
          const VoxelBlock& voxels = octant[block] == nullptr ? kUnobserved : *octant[block];
          const Voxel voxel =
              voxels.voxels[voxel_index(x % kBlockSide, y % kBlockSide, z % kBlockSide)];
          row.observed |= static_cast<unsigned>(voxel > threshold) << x;
          row.behind |= (voxel >> 15 & 1U) << x;
        }
      }
    }
  }

  /// Bit x is set where all corners of cube x of a row are observed and the surface crosses it.
  unsigned cubes_with_surface(int y, int z) const {
    unsigned observed = ~0U;
    unsigned all_behind = ~0U;
    unsigned any_behind = 0;
    for (const Row* row : rows_around(y, z)) {
      observed &= row->observed & row->observed >> 1;
      all_behind &= row->behind & row->behind >> 1;
      any_behind |= row->behind | row->behind >> 1;
    }
    return observed & any_behind & ~all_behind & 0xFFU;
  }

  /// The corners of a cube that are behind the surface, as cube_triangles() takes them.
  unsigned corners_behind(int x, int y, int z) const {
    unsigned corners = 0;
    int shift = 0;
    for (const Row* row : rows_around(y, z)) {
      corners |= (row->behind >> x & 3U) << shift;
      shift += 2;
    }
    return corners;
  }

 private:
  static constexpr int kCornerSide = kBlockSide + 1;
  struct Row {
    unsigned observed = 0;
    unsigned behind = 0;
  };

  std::array<const Row*, 4> rows_around(int y, int z) const {
    const Row* first = &rows_[z * kCornerSide + y];
    return {first, first + 1, first + kCornerSide, first + kCornerSide + 1};
  }

  std::array<Row, std::size_t{kCornerSide} * kCornerSide> rows_{};
};

}  // namespace kintsugi::mapper

#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapper/core/extraction/block_points.hpp"

namespace kintsugi::mapper {

/// The surface points in and around a block, over which its normals are averaged.
class PaddedPoints {
 public:
  static constexpr int kReach = 2;  ///< voxels

  /// A point as the sums want it: in four lanes.
  struct alignas(16) Point {
    std::array<float, 4> position_vox;  ///< from the block's lower corner
    std::array<float, 4> normal_W;
  };

  /// `around` are the points of the block and those around it, null where there are none.
  void assign(const std::array<const BlockPoints*, 27>& around);

  /// Calls visit(point, x, y, z of its voxel, mean normal) for each point of the block, in the
  /// order of voxels. The normal is the mean of the unit normals of the surface within
  /// `radius_vox` (at most kReach), those that face away from the point's own left out; unit.
  template <typename Visit>
  void for_each_in_block(float radius_vox, Visit visit) const {
    for (int z = 0; z < kBlockSide; ++z) {
      for (int y = 0; y < kBlockSide; ++y) {
        for (int x = 0; x < kBlockSide; ++x) {
          if ((row(y, z).mask >> (x + kReach) & 1U) == 0) continue;
          const Point& point = *points_of(row(y, z), x);
          visit(point, x, y, z, mean_normal(point, x, y, z, radius_vox));
        }
      }
    }
  }

 private:
  static constexpr int kSide = kBlockSide + 2 * kReach;
  /// Of 0 .. 63. Not every processor counts bits in one instruction, and a call costs more.
  static constexpr std::array<std::uint8_t, 64> kNumBits = [] {
    std::array<std::uint8_t, 64> counts{};
    for (unsigned i = 0; i < 64; ++i) counts[i] = static_cast<std::uint8_t>(std::popcount(i));
    return counts;
  }();
  struct Row {
    unsigned mask = 0;  ///< bit x + kReach: voxel x has a point
    int start = 0;      ///< its first point
  };

  const Row& row(int y, int z) const { return rows_[(z + kReach) * kSide + y + kReach]; }
  /// The row's first point not before voxel x.
  const Point* points_of(const Row& row, int x) const {
    const unsigned before = row.mask & ((1U << (x + kReach)) - 1U);
    return points_.data() + row.start + kNumBits[before & 63U] + kNumBits[before >> 6];
  }
  Eigen::Vector3f mean_normal(const Point& point, int x, int y, int z, float radius_vox) const;

  std::vector<Point> points_;
  std::array<Row, std::size_t{kSide} * kSide> rows_;
};

}  // namespace kintsugi::mapper

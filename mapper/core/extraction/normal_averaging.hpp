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

  /// Padded to four floats, so that the compiler can vectorise the sums.
  struct alignas(16) Point {
    std::array<float, 4> position_vox;  ///< from the block's lower corner
    std::array<float, 4> normal_W;
  };

  /// `around`: the points of the block and of the 26 around it; null where there are none.
  void assign(const std::array<const BlockPoints*, 27>& around);

  /// Calls visit(point, x, y, z of its voxel, mean normal) for each point of the block, in the
  /// order of the voxels. The mean normal is the normalised sum of the unit normals of all points
  /// within `radius_vox` (at most kReach) that are less than 90 degrees from the point's own.
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
  /// Number of set bits of 0 .. 63: faster than std::popcount where the build has no instruction
  /// for it.
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
  /// The first point of the row in voxel x or after it.
  const Point* points_of(const Row& row, int x) const {
    const unsigned before = row.mask & ((1U << (x + kReach)) - 1U);
    return points_.data() + row.start + kNumBits[before & 63U] + kNumBits[before >> 6];
  }
  Eigen::Vector3f mean_normal(const Point& point, int x, int y, int z, float radius_vox) const;

  std::vector<Point> points_;
  std::array<Row, std::size_t{kSide} * kSide> rows_;
};

}  // namespace kintsugi::mapper

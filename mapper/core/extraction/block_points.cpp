#include "mapper/core/extraction/block_points.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdlib>

namespace kintsugi::mapper {
namespace {

constexpr int kRowSide = kBlockSide + 2;  // with one voxel before and one after

/// One row of voxels; bit x + 1 is voxel x.
struct RowBits {
  unsigned observed = 0;
  unsigned behind = 0;

  /// Voxels with a crossing between them and the voxel at the same place in the other row.
  unsigned crossings_to(const RowBits& other) const {
    return observed & other.observed & (behind ^ other.behind);
  }
  RowBits shifted() const { return {observed >> 1, behind >> 1}; }
};

/// The rows of a block and those around it: y and z from -1 to 8.
class BlockBits {
 public:
  BlockBits(const PaddedBlock& block, int weight_threshold) {
    const Voxel threshold = (static_cast<Voxel>(weight_threshold) << 16U) | 0xFFFFU;
    for (int z = -1; z <= kBlockSide; ++z) {
      for (int y = -1; y <= kBlockSide; ++y) {
        RowBits& bits = rows_[(z + 1) * kRowSide + y + 1];
        const int first = PaddedBlock::index(-1, y, z);
        for (int i = 0; i < kRowSide; ++i) {
          const Voxel voxel = block[first + i];
          bits.observed |= static_cast<unsigned>(voxel > threshold) << i;
          bits.behind |= (voxel >> 15 & 1U) << i;
        }
      }
    }
  }

  /// Bit x is set where voxel x of a row has a crossing to one of its six neighbours.
  unsigned voxels_with_crossings(int y, int z) const {
    const RowBits& bits = row(y, z);
    const unsigned along_x = bits.crossings_to(bits.shifted());
    const unsigned found = along_x | along_x << 1 | bits.crossings_to(row(y - 1, z)) |
                           bits.crossings_to(row(y + 1, z)) | bits.crossings_to(row(y, z - 1)) |
                           bits.crossings_to(row(y, z + 1));
    return found >> 1 & 0xFFU;
  }

 private:
  const RowBits& row(int y, int z) const { return rows_[(z + 1) * kRowSide + y + 1]; }

  std::array<RowBits, std::size_t{kRowSide} * kRowSide> rows_{};
};

/// The mean of the crossings that lie in a voxel, relative to its centre, in voxels. False where
/// none does: all crossings next to it are nearer to the other voxel's centre.
bool mean_crossing(const PaddedBlock& block, int index, const CrossingRule& rule,
                   Eigen::Vector3f& offset_vox) {
  const int distance = voxel_distance_raw(block[index]);
  const int own = std::abs(distance);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  int count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      const Voxel other = block[index + side * PaddedBlock::kStride[axis]];
      const int other_distance = voxel_distance_raw(other);
      if ((distance < 0) == (other_distance < 0)) continue;
      if (voxel_weight(other) <= rule.weight_threshold) continue;
      // The crossing lies in the voxel with the nearer centre; half way, in the lower one.
      const int others = std::abs(other_distance);
      if (side > 0 ? own > others : own >= others) continue;
      if (own + others > rule.max_step_raw) continue;
      sum[axis] += static_cast<float>(side * own) / static_cast<float>(own + others);
      ++count;
    }
  }
  offset_vox = sum / static_cast<float>(count);
  return count > 0;
}

/// Derivative of the distance along one axis at a voxel's centre: a central difference; one-sided
/// where a neighbour was never observed, zero where neither was.
inline float difference_at(const PaddedBlock& block, int index, int stride) {
  const Voxel before = block[index - stride];
  const Voxel after = block[index + stride];
  const bool has_before = voxel_weight(before) > 0;
  const bool has_after = voxel_weight(after) > 0;
  if (has_before && has_after) {
    return static_cast<float>(voxel_distance_raw(after) - voxel_distance_raw(before)) * 0.5F;
  }
  if (!has_before && !has_after) return 0.0F;
  const int here = voxel_distance_raw(block[index]);
  return static_cast<float>(has_after ? voxel_distance_raw(after) - here
                                      : here - voxel_distance_raw(before));
}

/// Gradient of the distance at a point in a voxel, `offset_vox` from its centre: trilinear between
/// the observed voxels around it.
Eigen::Vector3f gradient_near(const PaddedBlock& block, int index,
                              const Eigen::Vector3f& offset_vox) {
  std::array<std::array<float, 2>, 3> shares{};  // of the nearer and the farther voxel
  std::array<int, 3> steps{};
  for (int axis = 0; axis < 3; ++axis) {
    const float offset = std::abs(offset_vox[axis]);
    shares[axis] = {1.0F - offset, offset};
    steps[axis] =
        offset_vox[axis] < 0.0F ? -PaddedBlock::kStride[axis] : PaddedBlock::kStride[axis];
  }
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    const int x = corner & 1;
    const int y = corner >> 1 & 1;
    const int z = corner >> 2;
    const float share = shares[0][x] * shares[1][y] * shares[2][z];
    if (share == 0.0F) continue;
    const int neighbor = index + x * steps[0] + y * steps[1] + z * steps[2];
    if (voxel_weight(block[neighbor]) == 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      sum[axis] += share * difference_at(block, neighbor, PaddedBlock::kStride[axis]);
    }
  }
  return sum;
}

}  // namespace

CrossingRule::CrossingRule(int weight_threshold, double max_step_vox, double resolution_m,
                           double truncation_m)
    : weight_threshold(weight_threshold),
      max_step_raw(static_cast<int>(std::min(2.0, max_step_vox * resolution_m / truncation_m) *
                                    kDistanceScale)) {}

BlockPoints::BlockPoints(const PaddedBlock& block, const CrossingRule& rule) {
  const BlockBits bits(block, rule.weight_threshold);
  for (int row = 0; row < kBlockSide * kBlockSide; ++row) {
    const int y = row % kBlockSide;
    const int z = row / kBlockSide;
    row_starts_[row] = static_cast<std::uint16_t>(points_.size());
    for (unsigned left = bits.voxels_with_crossings(y, z); left != 0; left &= left - 1) {
      const int x = std::countr_zero(left);
      const int index = PaddedBlock::index(x, y, z);
      Eigen::Vector3f offset_vox;
      if (!mean_crossing(block, index, rule, offset_vox)) continue;
      const Eigen::Vector3f gradient = gradient_near(block, index, offset_vox);
      if (gradient.isZero(0.0F)) continue;  // no direction to face
      points_.push_back({offset_vox, gradient.normalized()});
      row_masks_[row] |= static_cast<std::uint8_t>(1U << x);
    }
  }
}

ObservedSides observed_sides(const VoxelBlock& block, int weight_threshold) {
  const Voxel threshold = (static_cast<Voxel>(weight_threshold) << 16U) | 0xFFFFU;
  Voxel any_behind = 0;
  Voxel any_free = 0;
  for (const Voxel voxel : block.voxels) {  // no branches, so that the compiler can vectorise it
    const Voxel observed = voxel > threshold ? ~Voxel{0} : Voxel{0};
    any_behind |= observed & voxel;
    any_free |= observed & ~voxel;
  }
  constexpr Voxel kSign = 0x8000;
  return {.free_space = (any_free & kSign) != 0, .behind = (any_behind & kSign) != 0};
}

}  // namespace kintsugi::mapper

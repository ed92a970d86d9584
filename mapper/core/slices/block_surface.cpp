#include "mapper/core/slices/block_surface.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdlib>

#include "mapper/core/kernels/kernels.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kSide = BlockSurface::kSide;
constexpr int kLevelFactor = 4;

/// A row of ten voxels along x; bit i is voxel i - 1.
struct RowBits {
  unsigned observed = 0;
  unsigned behind = 0;

  /// Bit i is set where there may be a crossing between voxel i - 1 and the one at its place in the
  /// other row.
  unsigned crossings_to(const RowBits& other) const {
    return observed & other.observed & (behind ^ other.behind);
  }
  RowBits shifted() const { return {observed >> 1U, behind >> 1U}; }
};

/// A block's voxels and those that share a face with them, at places from -1 to 8.
class FacedBlock {
 public:
  FacedBlock(const TsdfVolume& volume, BlockSlot slot, int weight_threshold)
      : weight_threshold_(weight_threshold), own_(volume.voxels(slot).voxels.data()) {
    copy_rows(own_, 0, kBlockSide * kBlockSide, 0, 0);
    for (const unsigned end : {0U, 1U}) {
      BlockCoord across_x = volume.coord(slot);
      BlockCoord across_y = across_x;
      BlockCoord across_z = across_x;
      const int step = end == 0 ? -1 : 1;
      across_x.x += step;
      across_y.y += step;
      across_z.z += step;
      faces_[0][end] = voxels_of(volume, across_x);
      faces_[1][end] = voxels_of(volume, across_y);
      faces_[2][end] = voxels_of(volume, across_z);
      add_faces(end);
    }
  }

  const RowBits& row(int y, int z) const { return rows_[row_index(y, z)]; }

  /// Of a voxel whose bit `observed` is set.
  Voxel at(int x, int y, int z) const {
    const std::array<int, 3> place = {x, y, z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (place[axis] < 0) return faces_[axis][0][wrapped(x, y, z)];
      if (place[axis] >= kBlockSide) return faces_[axis][1][wrapped(x, y, z)];
    }
    return own_[voxel_index(x, y, z)];
  }

 private:
  static constexpr int kLast = kBlockSide - 1;

  static int row_index(int y, int z) { return (z + 1) * kSide + y + 1; }
  static int wrapped(int x, int y, int z) { return voxel_index(x & kLast, y & kLast, z & kLast); }
  static const Voxel* voxels_of(const TsdfVolume& volume, const BlockCoord& coord) {
    const BlockSlot slot = volume.find(coord);
    return slot == kNoBlock ? nullptr : volume.voxels(slot).voxels.data();
  }

  /// Rows `first` to `first + count` of a block, moved by whole blocks along y and z.
  void copy_rows(const Voxel* voxels, int first, int count, int blocks_y, int blocks_z) {
    static const FindBlockSides kFindSides = best_kernels().find_block_sides;
    std::array<RowSides, std::size_t{kBlockSide} * kBlockSide> sides;
    kFindSides(voxels + std::ptrdiff_t{kBlockSide} * first, count, weight_threshold_, sides.data());
    for (int i = 0; i < count; ++i) {
      const int y = (first + i) % kBlockSide + kBlockSide * blocks_y;
      const int z = (first + i) / kBlockSide + kBlockSide * blocks_z;
      if (y < -1 || y > kBlockSide) continue;
      rows_[row_index(y, z)] = {unsigned{sides[i].observed} << 1U, unsigned{sides[i].behind} << 1U};
    }
  }

  void add_faces(unsigned end) {
    const int step = end == 0 ? -1 : 1;
    if (const Voxel* across_z = faces_[2][end]) {
      copy_rows(across_z, end == 0 ? kBlockSide * kLast : 0, kBlockSide, 0, step);
    }
    if (const Voxel* across_y = faces_[1][end]) {
      // Rows come in pairs, of which one is at the face.
      for (int z = 0; z < kBlockSide; ++z) {
        copy_rows(across_y, z * kBlockSide + (end == 0 ? kLast - 1 : 0), 2, step, 0);
      }
    }
    if (const Voxel* across_x = faces_[0][end]) {
      const unsigned bit = end == 0 ? 0 : kSide - 1;
      for (int z = 0; z < kBlockSide; ++z) {
        for (int y = 0; y < kBlockSide; ++y) {
          const Voxel voxel = across_x[voxel_index(end == 0 ? kLast : 0, y, z)];
          RowBits& row = rows_[row_index(y, z)];
          row.observed |= static_cast<unsigned>(voxel_weight(voxel) > weight_threshold_) << bit;
          row.behind |= (voxel >> 15U & 1U) << bit;
        }
      }
    }
  }

  int weight_threshold_;
  const Voxel* own_;
  std::array<std::array<const Voxel*, 2>, 3> faces_{};  ///< [axis][end]; null: no such block
  std::array<RowBits, std::size_t{kSide} * kSide> rows_{};
};

constexpr unsigned kInside = 0xFFU << 1U;   // bits of a row that are in the block
constexpr unsigned kFirstOfPairs = 0x1FFU;  // all but the last: the first of two side by side

/// The row of voxels, and those within a voxel of it in any direction.
unsigned dilated(const BlockSurface& surface, int y, int z) {
  unsigned bits = 0;
  for (int dz = 0; dz <= 2; ++dz) {
    const auto* rows = &surface.voxels[(z + dz) * kSide + y];
    bits |= rows[0] | rows[1] | rows[2];
  }
  return bits | bits << 1U | bits >> 1U;
}

/// Whether the surface has moved by more than a quarter of a voxel on average, along the axis that
/// crosses it most often: along the others a slanted surface seems to move farther than it does.
bool has_moved(const BlockSurface& sent, const BlockSurface& now) {
  constexpr int kQuarter = BlockSurface::kUnitsPerVoxel / 4;
  std::array<int, 3> shift{};
  std::array<int, 3> num_common{};
  for (int i = 0; i < BlockSurface::kNumColumns; ++i) {
    const int before = sent.places[i];
    const int after = now.places[i];
    if (before == BlockSurface::kNone || after == BlockSurface::kNone) continue;
    const int axis = i / (kBlockSide * kBlockSide);
    shift[axis] += after - before;
    ++num_common[axis];
  }
  const auto main = std::max_element(num_common.begin(), num_common.end()) - num_common.begin();
  return std::abs(shift[main]) > kQuarter * num_common[main];
}

}  // namespace

BlockSurface::BlockSurface(const TsdfVolume& volume, BlockSlot slot, const CrossingRule& rule) {
  places.fill(kNone);
  const FacedBlock block(volume, slot, rule.weight_threshold);
  const int first_level = std::max(1, rule.weight_threshold) * kLevelFactor;
  std::array<int, 3> num_at_level{};

  // Between the voxel (x, y, z) and the next one along an axis, one of which is in the block.
  const auto add = [&](int axis, int x, int y, int z) {
    std::array<int, 3> lower = {x, y, z};
    std::array<int, 3> upper = lower;
    ++upper[axis];
    const Voxel a = block.at(lower[0], lower[1], lower[2]);
    const Voxel b = block.at(upper[0], upper[1], upper[2]);
    const int own = std::abs(voxel_distance_raw(a));
    const int other = std::abs(voxel_distance_raw(b));
    if (own + other > rule.max_step_raw) return;
    // It lies in the voxel with the nearer centre; half way, in the lower one.
    const std::array<int, 3>& voxel = own > other ? upper : lower;
    voxels[(voxel[2] + 1) * kSide + voxel[1] + 1] |=
        static_cast<std::uint16_t>(1U << static_cast<unsigned>(voxel[0] + 1));
    const int weight = std::min(voxel_weight(a), voxel_weight(b));
    ++num_at_level[weight >= kLevelFactor * first_level ? 2 : weight >= first_level ? 1 : 0];
    const int u = lower[axis == 0 ? 1 : 0];
    const int v = lower[axis == 2 ? 1 : 2];
    std::uint8_t& place = places[(axis * kBlockSide + v) * kBlockSide + u];
    if (place != kNone) return;
    place = static_cast<std::uint8_t>((lower[axis] + 1) * kUnitsPerVoxel +
                                      kUnitsPerVoxel * own / std::max(1, own + other));
  };
  const auto add_each = [&](int axis, unsigned crossings, int y, int z) {
    for (; crossings != 0; crossings &= crossings - 1) {
      add(axis, std::countr_zero(crossings) - 1, y, z);
    }
  };
  for (int z = -1; z < kBlockSide; ++z) {
    for (int y = -1; y < kBlockSide; ++y) {
      const RowBits& row = block.row(y, z);
      if (y >= 0 && z >= 0) add_each(0, row.crossings_to(row.shifted()) & kFirstOfPairs, y, z);
      if (z >= 0) add_each(1, row.crossings_to(block.row(y + 1, z)) & kInside, y, z);
      if (y >= 0) add_each(2, row.crossings_to(block.row(y, z + 1)) & kInside, y, z);
    }
  }
  const int half = (num_at_level[0] + num_at_level[1] + num_at_level[2] + 1) / 2;
  if (num_at_level[1] + num_at_level[2] >= half) level = num_at_level[2] >= half ? 2 : 1;
}

int BlockSurface::num_voxels() const {
  int count = 0;
  for (int z = 1; z <= kBlockSide; ++z) {
    for (int y = 1; y <= kBlockSide; ++y) count += std::popcount(voxels[z * kSide + y] & kInside);
  }
  return count;
}

BlockChange change_between(const BlockSurface& sent, const BlockSurface& now) {
  BlockChange change;
  for (int z = 0; z < kBlockSide; ++z) {
    for (int y = 0; y < kBlockSide; ++y) {
      const int row = (z + 1) * kSide + y + 1;
      const unsigned before = sent.voxels[row] & kInside;
      const unsigned after = now.voxels[row] & kInside;
      change.num_in_all += std::popcount(before | after);
      change.num_new +=
          std::popcount(after & ~dilated(sent, y, z)) + std::popcount(before & ~dilated(now, y, z));
    }
  }
  if (now.level > sent.level || has_moved(sent, now)) change.num_better = change.num_in_all;
  return change;
}

}  // namespace kintsugi::mapper

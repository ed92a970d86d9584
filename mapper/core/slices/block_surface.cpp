#include "mapper/core/slices/block_surface.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace kintsugi::mapper {
namespace {

constexpr int kSide = BlockSurface::kSide;
constexpr std::array<int, 3> kStride = {1, kSide, kSide* kSide};
constexpr int kLevelFactor = 4;

constexpr int index_of(int x, int y, int z) { return ((z + 1) * kSide + y + 1) * kSide + x + 1; }

/// The voxel at a place along an axis, in the column (u, v).
constexpr std::array<int, 3> place_at(int axis, int along, int u, int v) {
  std::array<int, 3> place{};
  place[axis] = along;
  place[(axis + 1) % 3] = u;
  place[(axis + 2) % 3] = v;
  return place;
}

/// The block's voxels and those that share a face with them.
class FacedBlock {
 public:
  FacedBlock(const TsdfVolume& volume, BlockSlot slot) {
    const BlockCoord& coord = volume.coord(slot);
    const Voxel* own = volume.voxels(slot).voxels.data();
    for (int z = 0; z < kBlockSide; ++z) {
      for (int y = 0; y < kBlockSide; ++y) {
        std::copy_n(own + voxel_index(0, y, z), kBlockSide, &voxels_[index_of(0, y, z)]);
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {-1, 1}) copy_face(volume, coord, axis, side);
    }
  }

  Voxel operator[](int index) const { return voxels_[index]; }

  /// Whether voxels above the threshold lie on either side of the surface. Without branches, so
  /// that the compiler can vectorise it: for most blocks the answer is no.
  bool has_both_sides(Voxel threshold) const {
    Voxel any_behind = 0;
    Voxel any_free = 0;
    for (const Voxel voxel : voxels_) {
      const Voxel observed = voxel > threshold ? ~Voxel{0} : Voxel{0};
      any_behind |= observed & voxel;
      any_free |= observed & ~voxel;
    }
    return ((any_behind & any_free) & 0x8000U) != 0;
  }

 private:
  void copy_face(const TsdfVolume& volume, BlockCoord coord, int axis, int side) {
    (axis == 0 ? coord.x : axis == 1 ? coord.y : coord.z) += side;
    const BlockSlot slot = volume.find(coord);
    if (slot == kNoBlock) return;
    const Voxel* other = volume.voxels(slot).voxels.data();
    const int from = side < 0 ? kBlockSide - 1 : 0;
    const int to = side < 0 ? -1 : kBlockSide;
    for (int v = 0; v < kBlockSide; ++v) {
      for (int u = 0; u < kBlockSide; ++u) {
        const auto [x, y, z] = place_at(axis, from, u, v);
        const auto [to_x, to_y, to_z] = place_at(axis, to, u, v);
        voxels_[index_of(to_x, to_y, to_z)] = other[voxel_index(x, y, z)];
      }
    }
  }

  std::array<Voxel, std::size_t{kSide} * kSide * kSide> voxels_{};  // 0: never observed
};

/// A row of voxels along x; bit i is voxel i - 1.
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

using BlockRows = std::array<RowBits, std::size_t{kSide} * kSide>;

BlockRows rows_of(const FacedBlock& block, Voxel threshold) {
  BlockRows rows;
  for (int row = 0; row < kSide * kSide; ++row) {
    for (int i = 0; i < kSide; ++i) {
      const Voxel voxel = block[row * kSide + i];
      rows[row].observed |= static_cast<unsigned>(voxel > threshold) << i;
      rows[row].behind |= (voxel >> 15 & 1U) << i;
    }
  }
  return rows;
}

constexpr unsigned kInside = 0xFFU << 1U;  // bits of a row that are in the block

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
  const Voxel threshold = (static_cast<Voxel>(rule.weight_threshold) << 16U) | 0xFFFFU;
  const FacedBlock block(volume, slot);
  if (!block.has_both_sides(threshold)) return;
  const BlockRows rows = rows_of(block, threshold);
  const int first_level = std::max(1, rule.weight_threshold) * kLevelFactor;
  std::array<int, 3> num_at_level{};

  // Between a voxel and the next one along an axis, one of which is in the block.
  const auto add = [&](int axis, int along, int column, int index) {
    const Voxel a = block[index];
    const Voxel b = block[index + kStride[axis]];
    const int own = std::abs(voxel_distance_raw(a));
    const int other = std::abs(voxel_distance_raw(b));
    if (own + other > rule.max_step_raw) return;
    // It lies in the voxel with the nearer centre; half way, in the lower one.
    const int voxel = own > other ? index + kStride[axis] : index;
    voxels[voxel / kSide] |= static_cast<std::uint16_t>(1U << (voxel % kSide));
    const int weight = std::min(voxel_weight(a), voxel_weight(b));
    ++num_at_level[weight >= kLevelFactor * first_level ? 2 : weight >= first_level ? 1 : 0];
    std::uint8_t& place = places[axis * kBlockSide * kBlockSide + column];
    if (place != kNone) return;
    place = static_cast<std::uint8_t>(along * kUnitsPerVoxel +
                                      kUnitsPerVoxel * own / std::max(1, own + other));
  };
  for (int z = 0; z <= kBlockSide; ++z) {
    for (int y = 0; y <= kBlockSide; ++y) {
      const int row = z * kSide + y;  // of voxels (y - 1, z - 1)
      const auto each = [&](int axis, unsigned crossings, int along, int column_row) {
        for (; crossings != 0; crossings &= crossings - 1) {
          const int x = std::countr_zero(crossings);
          const int column = axis == 0 ? column_row : column_row + x - 1;
          add(axis, axis == 0 ? x : along, column, row * kSide + x);
        }
      };
      if (y > 0 && z > 0) {
        each(0, rows[row].crossings_to(rows[row].shifted()) & 0x1FFU, 0,
             (z - 1) * kBlockSide + y - 1);
      }
      if (z > 0) each(1, rows[row].crossings_to(rows[row + 1]) & kInside, y, (z - 1) * kBlockSide);
      if (y > 0) {
        each(2, rows[row].crossings_to(rows[row + kSide]) & kInside, z, (y - 1) * kBlockSide);
      }
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

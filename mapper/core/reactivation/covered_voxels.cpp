#include "mapper/core/reactivation/covered_voxels.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

#include <tbb/parallel_for.h>

#include "mapper/core/volume/blocks_around.hpp"

namespace kintsugi::mapper {
namespace {

/// As far as normals are averaged.
constexpr int kReach = 2;  // voxels

/// Numbers of voxels at a surface.
struct Surroundings {
  int num_surface = 0;
  int num_covered = 0;  ///< of `num_surface`
};

/// The voxels of a block and those around it.
class PaddedVoxels {
 public:
  /// `blocks`: the block and the 26 around it, ascending; null where there are none.
  explicit PaddedVoxels(const std::array<const CoveredVoxels*, 27>& blocks) {
    std::size_t i = 0;
    for_each_around({}, [&](const BlockCoord& beside) {
      if (const CoveredVoxels* const block = blocks[i++]) copy(*block, beside);
    });
  }

  /// Of a voxel of the block, which is one of them.
  Surroundings around(int x, int y, int z) const {
    Surroundings sum;
    for (int dz = -kReach; dz <= kReach; ++dz) {
      for (int dy = -kReach; dy <= kReach; ++dy) {
        const std::uint8_t* const row = &voxels_[place(x, y + dy, z + dz)];
        for (int dx = -kReach; dx <= kReach; ++dx) {
          sum.num_surface += row[dx] & 1;
          sum.num_covered += row[dx] >> 1;
        }
      }
    }
    return sum;
  }

 private:
  static constexpr int kSide = kBlockSide + 2 * kReach;
  static int place(int x, int y, int z) {
    return ((z + kReach) * kSide + y + kReach) * kSide + x + kReach;
  }

  void copy(const CoveredVoxels& block, const BlockCoord& beside) {
    const auto first = [](int side) { return side < 0 ? kBlockSide - kReach : 0; };
    const auto end = [](int side) { return side > 0 ? kReach : kBlockSide; };
    for (int z = first(beside.z); z < end(beside.z); ++z) {
      for (int y = first(beside.y); y < end(beside.y); ++y) {
        for (int x = first(beside.x); x < end(beside.x); ++x) {
          const int index = voxel_index(x, y, z);
          if (!block.surface[index]) continue;
          voxels_[place(x + kBlockSide * beside.x, y + kBlockSide * beside.y,
                        z + kBlockSide * beside.z)] = block.covered[index] ? 3 : 1;
        }
      }
    }
  }

  /// 0: no surface, 1: surface, 3: covered surface
  std::array<std::uint8_t, std::size_t{kSide} * kSide * kSide> voxels_{};
};

/// Covers each voxel whose surroundings say so, and which does not differ.
template <typename IsCovered>
std::vector<CoveredVoxels> filtered(const std::vector<BlockCoord>& coords,
                                    const std::vector<CoveredVoxels>& blocks,
                                    IsCovered is_covered) {
  std::vector<std::size_t> order(coords.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto coord_of = [&](std::size_t i) { return coords[i]; };
  std::ranges::sort(order, {}, coord_of);
  const auto find = [&](const BlockCoord& coord) -> const CoveredVoxels* {
    const auto found = std::ranges::lower_bound(order, coord, {}, coord_of);
    return found == order.end() || coords[*found] != coord ? nullptr : &blocks[*found];
  };
  std::vector<CoveredVoxels> result = blocks;
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    const VoxelSet open = blocks[i].surface & ~blocks[i].differing;
    if (open.none()) return;
    std::array<const CoveredVoxels*, 27> around{};
    std::size_t next = 0;
    for_each_around(coords[i], [&](const BlockCoord& coord) { around[next++] = find(coord); });
    if (std::ranges::none_of(around, [](const CoveredVoxels* block) {
          return block != nullptr && block->covered.any();
        })) {
      return;
    }
    const PaddedVoxels voxels(around);
    for (int index = 0; index < kBlockVoxels; ++index) {
      if (!open[index]) continue;
      result[i].covered[index] = is_covered(voxels.around(
          index % kBlockSide, index / kBlockSide % kBlockSide, index / (kBlockSide * kBlockSide)));
    }
  });
  return result;
}

}  // namespace

std::vector<CoveredVoxels> closed(const std::vector<BlockCoord>& coords,
                                  const std::vector<CoveredVoxels>& blocks) {
  // Along a straight border the first moves it outwards by a voxel, the second back.
  const auto dilated = filtered(coords, blocks, [](const Surroundings& voxels) {
    return 3 * voxels.num_covered >= voxels.num_surface;
  });
  return filtered(coords, dilated, [](const Surroundings& voxels) {
    return 3 * voxels.num_covered > 2 * voxels.num_surface;
  });
}

}  // namespace kintsugi::mapper

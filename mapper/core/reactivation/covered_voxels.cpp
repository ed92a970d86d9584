#include "mapper/core/reactivation/covered_voxels.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include <tbb/parallel_for.h>

#include "mapper/core/extraction/normal_averaging.hpp"
#include "mapper/core/volume/blocks_around.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kReach = PaddedPoints::kReach;  // voxels; a speck disturbs the normals around it

constexpr std::size_t kNoNumber = SIZE_MAX;
using BlocksAround = std::array<std::size_t, 27>;  ///< numbers; kNoNumber: there is none

/// How many voxels are at a surface.
struct Surroundings {
  int num_surface = 0;
  int num_covered = 0;  ///< of `num_surface`
};

/// The voxels of a block and those around it.
class PaddedVoxels {
 public:
  /// `around`: the numbers of the block and the 26 around it, ascending.
  PaddedVoxels(const std::vector<CoveredVoxels>& blocks, const BlocksAround& around) {
    std::size_t i = 0;
    for_each_around({}, [&](const BlockCoord& beside) {
      if (const std::size_t number = around[i++]; number != kNoNumber) copy(blocks[number], beside);
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

/// Of each block, itself and the 26 around it, ascending.
std::vector<BlocksAround> blocks_around(const std::vector<BlockCoord>& coords) {
  std::vector<std::size_t> order(coords.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto coord_of = [&](std::size_t i) { return coords[i]; };
  std::ranges::sort(order, {}, coord_of);
  std::vector<BlocksAround> around(coords.size());
  tbb::parallel_for(std::size_t{0}, coords.size(), [&](std::size_t i) {
    std::size_t next = 0;
    for_each_around(coords[i], [&](const BlockCoord& coord) {
      const auto found = std::ranges::lower_bound(order, coord, {}, coord_of);
      const bool is_there = found != order.end() && coords[*found] == coord;
      around[i][next++] = is_there ? *found : kNoNumber;
    });
  });
  return around;
}

/// Covers each voxel whose surroundings say so, and which does not differ.
template <typename IsCovered>
std::vector<CoveredVoxels> filtered(const std::vector<CoveredVoxels>& blocks,
                                    const std::vector<BlocksAround>& around, IsCovered is_covered) {
  std::vector<CoveredVoxels> result = blocks;
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    const VoxelSet open = blocks[i].surface & ~blocks[i].differing;
    const bool may_change = open.any() && std::ranges::any_of(around[i], [&](std::size_t number) {
                              return number != kNoNumber && blocks[number].covered.any();
                            });
    if (!may_change) return;
    const PaddedVoxels voxels(blocks, around[i]);
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
  if (std::ranges::none_of(blocks, [](const CoveredVoxels& each) { return each.covered.any(); })) {
    return blocks;
  }
  const std::vector<BlocksAround> around = blocks_around(coords);
  // Along a straight border the first moves it outwards by a voxel, the second back.
  const auto dilated = filtered(blocks, around, [](const Surroundings& voxels) {
    return 3 * voxels.num_covered >= voxels.num_surface;
  });
  return filtered(dilated, around, [](const Surroundings& voxels) {
    return 3 * voxels.num_covered > 2 * voxels.num_surface;
  });
}

}  // namespace kintsugi::mapper

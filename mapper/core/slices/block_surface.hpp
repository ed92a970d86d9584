#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "mapper/core/extraction/block_points.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

/// Where the surface of a block is, and how well it was observed: as much as is needed to tell
/// whether it has changed since it was sent. Much cheaper than extracting its points.
struct BlockSurface {
  static constexpr int kSide = kBlockSide + 2;  ///< with one voxel of the blocks around
  static constexpr int kNumColumns = 3 * kBlockSide * kBlockSide;
  static constexpr std::uint8_t kNone = 0xFF;
  static constexpr int kUnitsPerVoxel = 16;

  /// Bit x + 1 of row (z + 1) * kSide + y + 1 is set where there is surface in voxel (x, y, z), by
  /// the same rule as the points; also in those voxels around the block that share a face with it.
  std::array<std::uint16_t, std::size_t{kSide} * kSide> voxels{};
  /// Of each column of eight voxels along x, y and z: where its first crossing is, in 1/16 voxel.
  std::array<std::uint8_t, kNumColumns> places;
  /// How often most of it was observed: 0 less than 4 times the threshold, 1 less than 16 times, 2
  /// more. Each level halves the noise of the level before.
  std::uint8_t level = 0;

  BlockSurface() { places.fill(kNone); }
  /// Of a block of the volume, which is in use.
  BlockSurface(const TsdfVolume& volume, BlockSlot slot, const CrossingRule& rule);

  /// Voxels of the block that have surface.
  int num_voxels() const;
};

/// How a block's surface differs from what was sent of it, in crossings.
struct BlockChange {
  int num_new = 0;     ///< that appeared or went
  int num_better = 0;  ///< that moved by more than a quarter of a voxel, or were observed more
  int num_in_all = 0;  ///< now or then
};
BlockChange change_between(const BlockSurface& sent, const BlockSurface& now);

}  // namespace kintsugi::mapper

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper {

/// A block's place in the pool; kNoBlock is none.
using BlockSlot = std::int32_t;
inline constexpr BlockSlot kNoBlock = -1;

/// Storage of blocks that are taken and given back: never moves a block, and recycles freed slots
/// before it grows. All blocks follow each other in the order of their slots, so that a vector of
/// 32-bit indices reaches every voxel. It does not shrink: its size is that of the fullest moment.
///
/// A slot is free again when all who hold it have given it back. For one thread, except that what
/// lend() returns may end on any other.
class TsdfBlockPool {
 public:
  /// The voxels of so many blocks have indices of 31 bits; 8 GB of them, and as much of colours.
  static constexpr std::size_t kMaxBlocks = (std::size_t{1} << 31) / kBlockVoxels;

  TsdfBlockPool();

  /// A slot, held once, whose voxels and colours are all zero. Invalidates no reference.
  /// @throws std::bad_alloc where there is no more memory or kMaxBlocks are held
  BlockSlot take(const BlockCoord& coord);
  /// A slot, held once, with the coordinate and the voxels of another; its colours are not set.
  /// @throws as take()
  BlockSlot take_copy_of_voxels(BlockSlot other);
  void hold(BlockSlot slot);       ///< once more
  void give_back(BlockSlot slot);  ///< one hold of it

  /// Passes on one hold of each of these slots to what is returned, which keeps their memory too,
  /// even beyond the pool. They are given back some time after it ended.
  std::shared_ptr<const void> lend(std::vector<BlockSlot> slots) const;

  VoxelBlock& voxels(BlockSlot slot) { return voxels_[slot]; }
  const VoxelBlock& voxels(BlockSlot slot) const { return voxels_[slot]; }
  ColorBlock& colors(BlockSlot slot) { return colors_[slot]; }
  const ColorBlock& colors(BlockSlot slot) const { return colors_[slot]; }
  const BlockCoord& coord(BlockSlot slot) const { return coords_[slot]; }

  /// Every slot that is held is below this.
  BlockSlot end() const { return static_cast<BlockSlot>(coords_.size()); }
  std::size_t memory_bytes() const;

 private:
  struct Memory;
  struct Returns;
  struct Loan;

  BlockSlot take_unset(BlockCoord coord);
  void grow();
  void collect_returns();

  std::shared_ptr<Memory> memory_;
  VoxelBlock* voxels_;  ///< the first, in memory_
  ColorBlock* colors_;  ///< the first, in memory_
  std::vector<BlockCoord> coords_;
  std::vector<std::uint8_t> holders_;
  std::vector<BlockSlot> free_;
  std::shared_ptr<Returns> returns_;
};

}  // namespace kintsugi::mapper

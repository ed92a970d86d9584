#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper {

/// The number of a block's storage in the pool; kNoBlock: none.
using BlockSlot = std::int32_t;
inline constexpr BlockSlot kNoBlock = -1;

/// Storage of blocks, with a reference count for each slot: never moves a block, reuses freed slots
/// before it grows, and does not shrink. Blocks are contiguous in the order of their slots, so that
/// 32-bit indices in a vector register reach every voxel.
///
/// Not thread-safe, except that the object that lend() returns may be destroyed on any thread.
class TsdfBlockPool {
 public:
  /// With this many blocks the index of a voxel still fits in 31 bits: 8 GB of voxels, 8 GB of
  /// colours.
  static constexpr std::size_t kMaxBlocks = (std::size_t{1} << 31) / kBlockVoxels;

  TsdfBlockPool();

  /// A slot with reference count 1 whose voxels and colours are all zero. Invalidates no reference.
  /// @throws std::bad_alloc if there is no more memory or kMaxBlocks slots are in use
  BlockSlot take(const BlockCoord& coord);
  /// The same, but what is in the voxels and colours is left to the caller.
  /// @throws std::bad_alloc as take()
  BlockSlot take_unset(BlockCoord coord);
  /// A slot with reference count 1 and the coordinate and voxels of another; its colours are not
  /// initialised.
  /// @throws std::bad_alloc as take()
  BlockSlot take_copy_of_voxels(BlockSlot other);
  void hold(BlockSlot slot);       ///< adds a reference
  void give_back(BlockSlot slot);  ///< removes a reference; the last one frees the slot

  /// Returns an object that takes over one reference to each of these slots, and keeps the memory
  /// alive even after the pool is gone. The references are removed some time after its destruction.
  std::shared_ptr<const void> lend(std::vector<BlockSlot> slots) const;

  VoxelBlock& voxels(BlockSlot slot) { return voxels_[slot]; }
  const VoxelBlock& voxels(BlockSlot slot) const { return voxels_[slot]; }
  ColorBlock& colors(BlockSlot slot) { return colors_[slot]; }
  const ColorBlock& colors(BlockSlot slot) const { return colors_[slot]; }
  const BlockCoord& coord(BlockSlot slot) const { return coords_[slot]; }

  /// All slots in use are below this.
  BlockSlot end() const { return static_cast<BlockSlot>(coords_.size()); }
  std::size_t memory_bytes() const;

 private:
  struct Memory;
  struct Returns;
  struct Loan;

  void grow();
  void collect_returns();

  std::shared_ptr<Memory> memory_;
  VoxelBlock* voxels_;  ///< of slot 0, in memory_
  ColorBlock* colors_;  ///< of slot 0, in memory_
  std::vector<BlockCoord> coords_;
  std::vector<std::uint8_t> holders_;
  std::vector<BlockSlot> free_;
  std::shared_ptr<Returns> returns_;
};

}  // namespace kintsugi::mapper

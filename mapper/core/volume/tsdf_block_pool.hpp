#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <queue>
#include <vector>

#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper {

/// The number of a block's storage in the pool; kNoBlock: none.
using BlockSlot = std::int32_t;
inline constexpr BlockSlot kNoBlock = -1;

/// Storage of blocks, with a reference count for each slot: never moves a block, reuses freed slots
/// before it grows, the lowest one first, and gives memory back page by page. Blocks are contiguous
/// in the order of their slots, so that 32-bit indices in a vector register reach every voxel.
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
  /// alive even after the pool is gone. The references are removed by the next tidy() after its
  /// destruction, or before the pool grows.
  std::shared_ptr<const void> lend(std::vector<BlockSlot> slots) const;

  /// Ends the references of loans that were destroyed, and gives the memory of pages without a
  /// block back to the system: where all blocks were lent and others took their place, there is
  /// twice as much as is needed.
  void tidy();

  VoxelBlock& voxels(BlockSlot slot) { return voxels_[slot]; }
  const VoxelBlock& voxels(BlockSlot slot) const { return voxels_[slot]; }
  ColorBlock& colors(BlockSlot slot) { return colors_[slot]; }
  const ColorBlock& colors(BlockSlot slot) const { return colors_[slot]; }
  const BlockCoord& coord(BlockSlot slot) const { return coords_[slot]; }

  /// All slots in use are below this.
  BlockSlot end() const { return static_cast<BlockSlot>(coords_.size()); }
  std::size_t memory_bytes() const;

 private:
  /// A huge page of voxels, and that of their colours.
  struct Page {
    int num_blocks = 0;
    bool has_memory = true;
  };
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
  std::vector<Page> pages_;
  std::size_t num_without_memory_ = 0;
  std::priority_queue<BlockSlot, std::vector<BlockSlot>, std::greater<>> free_;
  std::shared_ptr<Returns> returns_;
};

}  // namespace kintsugi::mapper

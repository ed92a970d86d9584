#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lcmtypes/base/reserved_memory.hpp"
#include "mapper/core/volume/tsdf_block.hpp"
#include "mapper/core/volume/tsdf_block_pool.hpp"

namespace kintsugi::mapper {

/// Finds the slots of blocks: a toroidal table, in which block (x, y, z) is at (x, y, z) modulo the
/// table's side, so that blocks stay where they are when the region around them moves. Its layout
/// is that of VolumeAccess. Memory is taken in pages, where there are blocks: 2 KB for a brick of 8
/// x 8 x 8 entries.
class BlockTable {
 public:
  /// For regions of up to `side` blocks a side.
  explicit BlockTable(int side);

  int side() const { return side_; }  ///< a power of two
  /// kNoBlock where none was set. Another block at the same place modulo side() is not told apart.
  BlockSlot find(const BlockCoord& coord) const { return entries()[index_of(coord)] - 1; }
  void set(const BlockCoord& coord, BlockSlot slot);
  void clear(const BlockCoord& coord) { set(coord, kNoBlock); }

  /// For VolumeAccess.
  const std::int32_t* entries() const {
    return reinterpret_cast<const std::int32_t*>(memory_.data());
  }
  /// Of the bricks in which there ever was a block.
  std::size_t memory_bytes() const;

 private:
  std::size_t index_of(const BlockCoord& coord) const;

  int side_;
  ReservedMemory memory_;
  std::vector<bool> is_brick_used_;
  std::size_t num_bricks_used_ = 0;
};

}  // namespace kintsugi::mapper

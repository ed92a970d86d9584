#pragma once

#include <cstddef>
#include <vector>

#include "mapper/core/reserved_memory.hpp"
#include "mapper/core/tsdf_block.hpp"

namespace kintsugi::mapper {

/// A block's place in the pool; kNoBlock is none.
using BlockSlot = std::int32_t;
inline constexpr BlockSlot kNoBlock = -1;

/// Storage of blocks that are taken and given back: never moves a block, and recycles freed slots
/// before it grows. All blocks follow each other in the order of their slots, so that a vector of
/// 32-bit indices reaches every voxel.
class TsdfBlockPool {
 public:
  /// The voxels of so many blocks have indices of 31 bits; 8 GB of them, and as much of colours.
  static constexpr std::size_t kMaxBlocks = (std::size_t{1} << 31) / kBlockVoxels;

  TsdfBlockPool();

  /// A slot whose voxels and colours are all zero. Invalidates no reference.
  /// @throws std::bad_alloc where there is no more memory or kMaxBlocks are in use
  BlockSlot take(const BlockCoord& coord);
  void give_back(BlockSlot slot);
  void clear();

  VoxelBlock& voxels(BlockSlot slot) { return first<VoxelBlock>(voxels_)[slot]; }
  const VoxelBlock& voxels(BlockSlot slot) const { return first<VoxelBlock>(voxels_)[slot]; }
  ColorBlock& colors(BlockSlot slot) { return first<ColorBlock>(colors_)[slot]; }
  const ColorBlock& colors(BlockSlot slot) const { return first<ColorBlock>(colors_)[slot]; }
  const BlockCoord& coord(BlockSlot slot) const { return coords_[slot]; }

  /// Every slot in use is below this.
  BlockSlot end() const { return static_cast<BlockSlot>(coords_.size()); }
  bool in_use(BlockSlot slot) const { return in_use_[slot] != 0; }
  std::size_t size() const { return coords_.size() - free_.size(); }
  std::size_t memory_bytes() const;

 private:
  template <typename Block>
  static Block* first(ReservedMemory& memory) {
    return reinterpret_cast<Block*>(memory.data());
  }
  template <typename Block>
  static const Block* first(const ReservedMemory& memory) {
    return reinterpret_cast<const Block*>(memory.data());
  }

  ReservedMemory voxels_;
  ReservedMemory colors_;
  std::vector<BlockCoord> coords_;
  std::vector<unsigned char> in_use_;
  std::vector<BlockSlot> free_;
};

}  // namespace kintsugi::mapper

#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "mapper/core/tsdf_block.hpp"

namespace kintsugi::mapper {

/// A block's place in the pool; kNoBlock is none.
using BlockSlot = std::int32_t;
inline constexpr BlockSlot kNoBlock = -1;

/// Storage of blocks that are taken and given back: grows in chunks, never moves a block, and
/// recycles freed slots before it grows.
class TsdfBlockPool {
 public:
  /// A slot whose voxels and colours are all zero. Invalidates no reference.
  BlockSlot take(const BlockCoord& coord);
  void give_back(BlockSlot slot);
  void clear();

  VoxelBlock& voxels(BlockSlot slot) { return chunk_of(slot).voxels[index_in_chunk(slot)]; }
  const VoxelBlock& voxels(BlockSlot slot) const {
    return chunk_of(slot).voxels[index_in_chunk(slot)];
  }
  ColorBlock& colors(BlockSlot slot) { return chunk_of(slot).colors[index_in_chunk(slot)]; }
  const ColorBlock& colors(BlockSlot slot) const {
    return chunk_of(slot).colors[index_in_chunk(slot)];
  }
  const BlockCoord& coord(BlockSlot slot) const { return coords_[slot]; }

  /// Every slot in use is below this.
  BlockSlot end() const { return static_cast<BlockSlot>(coords_.size()); }
  bool in_use(BlockSlot slot) const { return in_use_[slot] != 0; }
  std::size_t size() const { return coords_.size() - free_.size(); }
  std::size_t memory_bytes() const;

 private:
  static constexpr int kChunkBits = 10;
  static constexpr int kChunkBlocks = 1 << kChunkBits;
  struct Chunk {
    std::array<VoxelBlock, kChunkBlocks> voxels;
    std::array<ColorBlock, kChunkBlocks> colors;
  };

  static int index_in_chunk(BlockSlot slot) { return slot & (kChunkBlocks - 1); }
  Chunk& chunk_of(BlockSlot slot) { return *chunks_[slot >> kChunkBits]; }
  const Chunk& chunk_of(BlockSlot slot) const { return *chunks_[slot >> kChunkBits]; }

  std::vector<std::unique_ptr<Chunk>> chunks_;
  std::vector<BlockCoord> coords_;
  std::vector<unsigned char> in_use_;
  std::vector<BlockSlot> free_;
};

}  // namespace kintsugi::mapper

#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "mapper/core/reactivation/block_packing.hpp"
#include "mapper/core/volume/stored_block.hpp"

namespace kintsugi::mapper {

/// A block as it was when it left the volume, packed or not. Copies share its memory, which does
/// not change, so that each thread may use one.
class KeptBlock {
 public:
  /// `storage` keeps voxels and colours alive.
  KeptBlock(const BlockCoord& coord, const VoxelBlock& voxels, const ColorBlock& colors,
            std::shared_ptr<const void> storage)
      : coord_(coord), voxels_(&voxels), colors_(&colors), storage_(std::move(storage)) {}

  const BlockCoord& coord() const { return coord_; }

  /// In less memory.
  KeptBlock packed() const { return packed_ ? *this : KeptBlock(pack(coord_, *voxels_, *colors_)); }

  void copy_to(VoxelBlock& voxels, ColorBlock& colors) const {
    if (packed_) return unpack(*packed_, voxels, colors);
    voxels = *voxels_;
    colors = *colors_;
  }
  StoredBlock copy() const {
    StoredBlock block{coord_, {}, {}};
    copy_to(block.voxels, block.colors);
    return block;
  }

  std::size_t bytes() const {
    return packed_ ? packed_->bytes.size() : sizeof(VoxelBlock) + sizeof(ColorBlock);
  }

 private:
  explicit KeptBlock(PackedBlock packed)
      : coord_(packed.coord), packed_(std::make_shared<const PackedBlock>(std::move(packed))) {}

  BlockCoord coord_;
  const VoxelBlock* voxels_ = nullptr;
  const ColorBlock* colors_ = nullptr;
  std::shared_ptr<const void> storage_;
  std::shared_ptr<const PackedBlock> packed_;  ///< or else there are voxels and colours
};

}  // namespace kintsugi::mapper

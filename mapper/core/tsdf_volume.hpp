#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <vector>

#include "mapper/core/detached_blocks.hpp"
#include "mapper/core/tsdf_block.hpp"
#include "mapper/core/tsdf_block_pool.hpp"

namespace kintsugi::mapper {

/// A cube of truncated signed distances that moves with the camera, in whole blocks.
///
/// Only blocks near a surface exist. They are found through a toroidal table: the cube's block
/// (x, y, z) is at (x, y, z) modulo the table's side, so that moving the cube moves no block.
/// Not safe for concurrent use, except that different blocks may be written at once.
class TsdfVolume {
 public:
  struct Config {
    double volume_size_m = 4.5;       ///< side of the cube, rounded up to whole blocks
    double resolution_m = 4.5 / 512;  ///< side of a voxel
    double truncation_vox = 4.0;      ///< distances are clamped to this
    int max_weight = 128;             ///< the running mean forgets older observations beyond this
    int shift_vox = 14;  ///< the cube moves when the camera is further than this from its centre

    /// @throws std::invalid_argument naming the field, its value and the bound.
    void validate() const;
  };

  /// An empty cube, centred at `center_W` (metres) to the nearest block. @throws as validate() and
  /// shift_to() do.
  explicit TsdfVolume(const Config& config,
                      const Eigen::Vector3d& center_W = Eigen::Vector3d::Zero());

  const Config& config() const { return config_; }
  float resolution_m() const { return static_cast<float>(config_.resolution_m); }
  float truncation_m() const {
    return static_cast<float>(config_.resolution_m * config_.truncation_vox);
  }
  int side_blocks() const { return side_blocks_; }
  /// The cube is blocks min_block() .. min_block() + side_blocks() - 1 along each axis.
  const BlockCoord& min_block() const { return min_block_; }
  Eigen::Vector3d center_W() const;  ///< metres

  bool contains(const BlockCoord& coord) const { return is_inside(coord, min_block_); }
  /// The block's slot; kNoBlock where it was not allocated or is outside the cube.
  BlockSlot find(const BlockCoord& coord) const {
    return contains(coord) ? table_[table_index(coord)] : kNoBlock;
  }
  /// The block's slot, a new and unobserved block where there was none. `coord` is inside the cube.
  BlockSlot allocate(const BlockCoord& coord);

  VoxelBlock& voxels(BlockSlot slot) { return pool_.voxels(slot); }
  const VoxelBlock& voxels(BlockSlot slot) const { return pool_.voxels(slot); }
  ColorBlock& colors(BlockSlot slot) { return pool_.colors(slot); }
  const ColorBlock& colors(BlockSlot slot) const { return pool_.colors(slot); }
  const BlockCoord& coord(BlockSlot slot) const { return pool_.coord(slot); }

  /// Slots in use are below slots_end(); not all below it are in use.
  BlockSlot slots_end() const { return pool_.end(); }
  bool in_use(BlockSlot slot) const { return pool_.in_use(slot); }

  /// Moves the cube so that the camera is within half a block of its centre along each axis along
  /// which it was further than shift_vox, and hands out what fell out: one object for each axis (x,
  /// y, z in this order) along which something did. Blocks that enter are empty.
  /// @throws std::invalid_argument where the position is not finite or further than 100 km away;
  /// the volume is unchanged then.
  std::vector<DetachedBlocks> shift_to(const Eigen::Vector3d& camera_W);

  /// What is in the cube, as a final slice; the volume is unchanged.
  DetachedBlocks snapshot() const;
  /// What is in the cube, as a final slice; the volume is empty afterwards.
  DetachedBlocks detach_all();

  std::size_t num_blocks() const { return pool_.size(); }
  std::size_t memory_bytes() const;

 private:
  bool is_inside(const BlockCoord& coord, const BlockCoord& min_block) const {
    const auto side = static_cast<unsigned>(side_blocks_);
    return static_cast<unsigned>(coord.x - min_block.x) < side &&
           static_cast<unsigned>(coord.y - min_block.y) < side &&
           static_cast<unsigned>(coord.z - min_block.z) < side;
  }
  std::size_t table_index(const BlockCoord& coord) const {
    const auto wrap = [mask = table_side_ - 1](int c) {
      return static_cast<std::size_t>(static_cast<unsigned>(c) & mask);
    };
    return (wrap(coord.z) * table_side_ + wrap(coord.y)) * table_side_ + wrap(coord.x);
  }
  std::vector<BlockSlot> slots_outside(const BlockCoord& min_block) const;
  DetachedBlocks copy_blocks(std::vector<BlockSlot> slots, SliceKind kind) const;
  void copy_apron(DetachedBlocks& blocks) const;
  void release(const DetachedBlocks& blocks);
  void remember_departed(const DetachedBlocks& blocks);

  Config config_;
  int side_blocks_ = 0;
  unsigned table_side_ = 0;  ///< a power of two, at least side_blocks_
  BlockCoord min_block_;
  std::vector<BlockSlot> table_;
  TsdfBlockPool pool_;
  /// The layer of blocks just outside the cube, as they were when they left: the surface between
  /// them and what stays can only be extracted with both sides at hand.
  std::map<BlockCoord, VoxelBlock> departed_;
};

}  // namespace kintsugi::mapper

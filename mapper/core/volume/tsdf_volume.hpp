#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapper/core/volume/detached_blocks.hpp"
#include "mapper/core/volume/tsdf_block.hpp"
#include "mapper/core/volume/tsdf_block_pool.hpp"

namespace kintsugi::mapper {

/// A cube of truncated signed distances that moves with the camera, in whole blocks.
///
/// Only blocks near a surface exist. They are found through a toroidal table: the cube's block
/// (x, y, z) is at (x, y, z) modulo the table's side, so that moving the cube moves no block.
///
/// Memory: 4 KB a block; with voxels of 8.8 mm 11.8 MB for a cubic metre of blocks, 1.9 MB for a
/// square metre of surface in a furnished room. It grows to what the cube held at its fullest,
/// with the layer that left last and what is being extracted, and stays there on a walk of any
/// length.
///
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
  int side_blocks() const { return cube_.side; }
  /// The cube is blocks min_block() .. min_block() + side_blocks() - 1 along each axis.
  const BlockCoord& min_block() const { return cube_.min; }
  Eigen::Vector3d center_W() const;  ///< metres

  bool contains(const BlockCoord& coord) const { return cube_.contains(coord); }
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

  /// What find() looks into, for vector registers: table_side() cubed slots, kNoBlock where there
  /// is no block. Block (x, y, z) of the cube is at x + table_side() (y + table_side() z), each
  /// coordinate modulo table_side(), which is a power of two.
  const BlockSlot* table() const { return table_.data(); }
  int table_side() const { return static_cast<int>(table_side_); }
  /// Voxel i of a slot is 512 slot + i words from here.
  const Voxel* first_voxel() const { return pool_.voxels(0).voxels.data(); }

  /// The cube's blocks have slots below slots_end(); not all slots below it are the cube's.
  BlockSlot slots_end() const { return static_cast<BlockSlot>(in_use_.size()); }
  bool in_use(BlockSlot slot) const { return in_use_[slot] != 0; }

  /// Moves the cube so that the camera is within half a block of its centre along each axis along
  /// which it was further than shift_vox, and hands out what fell out: one object for each axis (x,
  /// y, z in this order) along which something did. Blocks that enter are empty. Nothing that
  /// leaves is copied: its slots are used again when the object has ended, on whichever thread.
  /// @throws std::invalid_argument where the position is not finite or further than 100 km away;
  /// the volume is unchanged then.
  std::vector<DetachedBlocks> shift_to(const Eigen::Vector3d& camera_W);

  /// A copy of what is in the cube, as a final slice; the volume is unchanged.
  DetachedBlocks snapshot() const;
  /// What is in the cube, as a final slice; the volume is empty afterwards.
  DetachedBlocks detach_all();

  std::size_t num_blocks() const { return num_blocks_; }  ///< in the cube
  std::size_t memory_bytes() const;                       ///< with what is handed out

 private:
  std::size_t table_index(const BlockCoord& coord) const {
    const auto wrap = [mask = table_side_ - 1](int c) {
      return static_cast<std::size_t>(static_cast<unsigned>(c) & mask);
    };
    return (wrap(coord.z) * table_side_ + wrap(coord.y)) * table_side_ + wrap(coord.x);
  }
  /// The cube's blocks that are not in `remaining`, ascending.
  std::vector<BlockSlot> slots_outside(const BlockCube& remaining) const;
  /// The blocks that touch these: of those in `remaining` and those that left before, ascending.
  std::vector<BlockSlot> slots_around_outside(const BlockCube& remaining) const;
  template <typename Keep>
  DetachedBlocks describe(const std::vector<BlockSlot>& slots, SliceKind kind,
                          const BlockCube& remaining, Keep keep) const;
  DetachedBlocks detach(SliceKind kind, const BlockCube& remaining);
  void remove(const std::vector<BlockSlot>& slots);
  void update_departed(const std::vector<BlockSlot>& leaving, const BlockCube& remaining);
  void sort_by_coord(std::vector<BlockSlot>& slots) const;

  Config config_;
  BlockCube cube_;
  unsigned table_side_ = 0;  ///< a power of two, at least the cube's
  std::vector<BlockSlot> table_;
  TsdfBlockPool pool_;
  std::vector<std::uint8_t> in_use_;  ///< by slot: whether it is a block of the cube
  std::size_t num_blocks_ = 0;
  /// The blocks just outside the cube that left it, as they were then: the surface between them and
  /// what stays can only be extracted with both sides at hand.
  std::vector<BlockSlot> departed_;
};

}  // namespace kintsugi::mapper

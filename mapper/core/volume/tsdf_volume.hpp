#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapper/core/kernels/volume_access.hpp"
#include "mapper/core/volume/detached_blocks.hpp"
#include "mapper/core/volume/tsdf_block.hpp"
#include "mapper/core/volume/tsdf_block_pool.hpp"

namespace kintsugi::mapper {

/// A cube of truncated signed distances that moves with the camera, in whole blocks.
///
/// Only blocks near a surface exist. They are found through a toroidal table: the cube's block
/// (x, y, z) is at (x, y, z) modulo the table's side, so that a shift of the cube moves no block.
///
/// Memory: 4 KB a block; with voxels of 8.8 mm 11.8 MB for a cubic metre of blocks, 1.9 MB for a
/// square metre of surface in a furnished room. It grows to the most that was ever needed at once
/// for the cube, the layer that left last and the slices being extracted, whatever the length of
/// the camera's path.
///
/// Not thread-safe, except that several threads may write different blocks.
class TsdfVolume {
 public:
  struct Config {
    double volume_size_m = 4.5;       ///< side of the cube, rounded up to whole blocks
    double resolution_m = 4.5 / 512;  ///< side of a voxel
    double truncation_vox = 4.0;      ///< distances are clamped to this
    int max_weight = 128;             ///< beyond this the running mean forgets old observations
    int shift_vox = 14;  ///< the cube moves when the camera is farther than this from its centre

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// An empty cube, centred at `center_W` (metres) to the nearest block.
  /// @throws std::invalid_argument as validate() and shift_to()
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

  /// Valid until the volume changes.
  VolumeAccess kernel_access() const;

  /// Every block of the cube has a slot below slots_end(), but not every such slot is in the cube:
  /// see in_use().
  BlockSlot slots_end() const { return static_cast<BlockSlot>(in_use_.size()); }
  bool in_use(BlockSlot slot) const { return in_use_[slot] != 0; }

  /// Centres the cube on the camera, to the nearest block, along each axis on which the camera is
  /// farther than shift_vox from the centre. Returns the blocks that left: one object for each axis
  /// (in the order x, y, z) along which any did. Space that enters is empty. Blocks that leave are
  /// not copied; their slots are used again after the returned object has been destroyed, which may
  /// happen on any thread.
  /// @throws std::invalid_argument where the position is not finite or farther than 100 km from W's
  /// origin; the volume is unchanged then
  std::vector<DetachedBlocks> shift_to(const Eigen::Vector3d& camera_W);

  /// A copy of all blocks of the cube, as a final slice; the volume is unchanged.
  DetachedBlocks snapshot() const;
  /// All blocks of the cube, as a final slice; the volume is empty afterwards.
  DetachedBlocks detach_all();

  std::size_t num_blocks() const { return num_blocks_; }  ///< in the cube
  std::size_t memory_bytes() const;                       ///< including blocks that are handed out

 private:
  std::size_t table_index(const BlockCoord& coord) const {
    const auto wrap = [mask = table_side_ - 1](int c) {
      return static_cast<std::size_t>(static_cast<unsigned>(c) & mask);
    };
    return (wrap(coord.z) * table_side_ + wrap(coord.y)) * table_side_ + wrap(coord.x);
  }
  /// The cube's blocks that are not in `remaining`, ascending.
  std::vector<BlockSlot> slots_outside(const BlockCube& remaining) const;
  /// The blocks that touch those outside `remaining`: blocks in `remaining` and blocks that left
  /// before; ascending.
  std::vector<BlockSlot> slots_around_outside(const BlockCube& remaining) const;
  template <typename Keep>
  DetachedBlocks describe(const std::vector<BlockSlot>& slots, SliceKind kind,
                          const BlockCube& remaining, Keep keep) const;
  DetachedBlocks detach(SliceKind kind, const BlockCube& remaining);
  void remove(const std::vector<BlockSlot>& slots);
  void update_departed(const std::vector<BlockSlot>& leaving, const BlockCube& remaining);
  void sort_by_coord(std::vector<BlockSlot>& slots) const;
  static void check_position(const Eigen::Vector3d& position_W);

  Config config_;
  BlockCube cube_;
  unsigned table_side_ = 0;  ///< a power of two, at least the cube's
  std::vector<BlockSlot> table_;
  TsdfBlockPool pool_;
  std::vector<std::uint8_t> in_use_;  ///< by slot: whether it is a block of the cube
  std::size_t num_blocks_ = 0;
  /// Blocks that left and touch the cube, as they were then: extracting the surface between them
  /// and blocks that leave later needs both.
  std::vector<BlockSlot> departed_;
};

}  // namespace kintsugi::mapper

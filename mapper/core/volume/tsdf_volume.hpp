#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mapper/core/kernels/volume_access.hpp"
#include "mapper/core/volume/block_region.hpp"
#include "mapper/core/volume/block_table.hpp"
#include "mapper/core/volume/detached_blocks.hpp"
#include "mapper/core/volume/tsdf_block.hpp"
#include "mapper/core/volume/tsdf_block_pool.hpp"

namespace kintsugi::mapper {

/// Truncated signed distances in a region that moves with the camera, in whole blocks: a ball
/// around the camera that reaches beyond all it can see, so that turning round loses nothing, or a
/// cube (Whelan et al. 2012). Only blocks near a surface exist.
///
/// The ball takes no more memory than max_memory_mb: above that, the blocks that have been out of
/// view for longest leave.
///
/// Memory: 4 KB a block; with voxels of 8.8 mm 11.8 MB for a cubic metre of blocks, 1.9 MB for a
/// square metre of surface in a furnished room. It is what is needed for the region, the blocks
/// that left last and the slices being extracted, in pages of 4 MB, whatever the length of the
/// camera's path.
///
/// Not thread-safe, except that several threads may write different blocks.
class TsdfVolume {
 public:
  struct Config {
    RegionShape region = RegionShape::kBall;
    /// Surface within this distance of the camera is inside the ball, with truncation_vox behind
    /// it.
    double max_range_m = 5.0;
    double volume_size_m = 4.5;       ///< side of the cube, rounded up to whole blocks
    double resolution_m = 4.5 / 512;  ///< side of a voxel
    double truncation_vox = 4.0;  ///< distances are clamped to this, or more where depth is noisy
    double max_truncation_vox =
        16.0;              ///< of the ball, where depth is noisy; the cube has one truncation
    int max_weight = 128;  ///< beyond this the running mean forgets old observations
    /// The region moves when the camera is farther than this from its centre along an axis.
    int shift_vox = 14;
    /// Of the ball's blocks, 1e6 bytes; more only while more are in view.
    double max_memory_mb = 180.0;

    double largest_truncation_vox() const {
      return region == RegionShape::kCube ? truncation_vox : max_truncation_vox;
    }
    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// The largest max_range_m of a ball, given the other members.
  static double longest_range_m(const Config& config);

  /// An empty region, centred at `center_W` (metres) to the nearest block.
  /// @throws std::invalid_argument as validate() and shift_to()
  explicit TsdfVolume(const Config& config,
                      const Eigen::Vector3d& center_W = Eigen::Vector3d::Zero());

  /// Moves the region there, as in the constructor, whatever the threshold of shift_to().
  /// @pre it is empty
  /// @throws std::invalid_argument as shift_to()
  void center_at(const Eigen::Vector3d& center_W);

  const Config& config() const { return config_; }
  float resolution_m() const { return static_cast<float>(config_.resolution_m); }
  /// The smallest; see truncation_by_depth().
  float truncation_m() const {
    return static_cast<float>(config_.resolution_m * config_.truncation_vox);
  }
  /// Stored distances are fractions of this.
  float max_truncation_m() const {
    return static_cast<float>(config_.resolution_m * config_.largest_truncation_vox());
  }
  /// As many as fit into max_memory_mb.
  std::size_t max_blocks() const {
    return static_cast<std::size_t>(1e6 * config_.max_memory_mb / kBlockBytes);
  }
  int side_blocks() const { return region_.side; }
  /// The region is in blocks min_block() .. min_block() + side_blocks() - 1 along each axis.
  const BlockCoord& min_block() const { return region_.min; }
  Eigen::Vector3d center_W() const;  ///< metres

  bool contains(const BlockCoord& coord) const { return region_.contains(coord); }
  /// The block's slot; kNoBlock where it was not allocated or is outside the region.
  BlockSlot find(const BlockCoord& coord) const {
    return contains(coord) ? table_.find(coord) : kNoBlock;
  }
  /// The block's slot, a new and unobserved block where there was none. `coord` is in the region.
  BlockSlot allocate(const BlockCoord& coord);
  /// Says that a block is in view, so that it is among the last to leave a ball that is too full.
  void mark_seen(BlockSlot slot) { last_seen_[slot] = num_moves_; }
  /// The number of calls of shift_to() when a block was last in view.
  std::uint32_t last_seen(BlockSlot slot) const { return last_seen_[slot]; }
  /// Whether a block was in view after so many calls of shift_to().
  bool seen_since(BlockSlot slot, std::uint32_t num_moves) const {
    return last_seen_[slot] > num_moves;
  }

  /// Frees a block without surface: it is in no slice.
  void discard(BlockSlot slot);
  /// The number of calls of shift_to().
  std::uint32_t num_moves() const { return num_moves_; }

  VoxelBlock& voxels(BlockSlot slot) { return pool_.voxels(slot); }
  const VoxelBlock& voxels(BlockSlot slot) const { return pool_.voxels(slot); }
  ColorBlock& colors(BlockSlot slot) { return pool_.colors(slot); }
  const ColorBlock& colors(BlockSlot slot) const { return pool_.colors(slot); }
  const BlockCoord& coord(BlockSlot slot) const { return pool_.coord(slot); }

  /// Valid until the volume changes.
  VolumeAccess kernel_access() const;

  /// Every block of the volume has a slot below slots_end(), but not every such slot is in use: see
  /// in_use().
  BlockSlot slots_end() const { return static_cast<BlockSlot>(in_use_.size()); }
  bool in_use(BlockSlot slot) const { return in_use_[slot] != 0; }

  /// Called with blocks of a ball that are about to leave; may change and discard them.
  using BeforeLeaving = std::function<void(const std::vector<BlockSlot>&)>;

  /// Centres the region on the camera, to the nearest block, along each axis on which the camera is
  /// farther than shift_vox from the centre. Returns the blocks that left. Of a cube: one object
  /// for each axis (in the order x, y, z) along which any did, with the direction of the motion as
  /// kind. Of a ball: one object, if any did; its kind says on which side of their mean the centre
  /// is. Space that enters is empty. Blocks that leave are not copied; their slots are used again
  /// after the returned object has been destroyed, which may happen on any thread.
  ///
  /// To be called once a frame, before the frame is fused: of a ball with more than max_blocks(),
  /// the blocks that were in view longest ago leave, a sixteenth of max_blocks() at a time; never
  /// those seen since the call before.
  /// @throws std::invalid_argument where the position is not finite or farther than 100 km from W's
  /// origin; the volume is unchanged then
  std::vector<DetachedBlocks> shift_to(const Eigen::Vector3d& camera_W,
                                       const BeforeLeaving& before_leaving = {});

  /// A copy of all blocks, as a final slice; the volume is unchanged.
  DetachedBlocks snapshot();
  /// A copy of these blocks, in any order, as a patch; the volume is unchanged.
  DetachedBlocks snapshot(std::vector<BlockSlot> slots);
  /// These blocks, in any order, which the volume then has no more.
  DetachedBlocks detach(std::vector<BlockSlot> slots, SliceKind kind);
  /// All blocks; the volume is empty afterwards.
  DetachedBlocks detach_all(SliceKind kind = SliceKind::kFinal);

  /// Writes block i of those that come back, and then of those around them, as it was when it left.
  using WriteBlock = std::function<void(std::size_t i, VoxelBlock&, ColorBlock&)>;
  /// Puts blocks of a ball back as they were when they left; in view. They are in the region, and
  /// replace what the volume has at their places. `around`: blocks that left, too, and share a
  /// face, an edge or a corner with those. `write` is called from several threads.
  void restore(std::span<const BlockCoord> blocks, std::span<const BlockCoord> around,
               const WriteBlock& write);

  std::size_t num_blocks() const { return num_blocks_; }  ///< in the region
  std::size_t memory_bytes() const;                       ///< including blocks that are handed out

 private:
  static constexpr double kBlockBytes = sizeof(VoxelBlock) + sizeof(ColorBlock);

  std::vector<DetachedBlocks> shift_cube(const Eigen::Vector3d& offset_vox);
  std::vector<DetachedBlocks> shift_ball(const Eigen::Vector3d& offset_vox,
                                         const BeforeLeaving& before_leaving);
  /// The blocks that are not in `region`, ascending.
  std::vector<BlockSlot> slots_outside(const BlockRegion& region) const;
  /// Those of the blocks in `region` that were in view longest ago, in no particular order; none
  /// that was seen since the move before this one.
  std::vector<BlockSlot> longest_out_of_view(const BlockRegion& region, std::size_t count) const;
  /// The blocks that touch those that leave: blocks that stay and blocks that left before;
  /// ascending.
  std::vector<BlockSlot> slots_around(const std::vector<BlockSlot>& leaving) const;
  SliceKind kind_of(const std::vector<BlockSlot>& leaving, const BlockRegion& region) const;
  DetachedBlocks copy(const std::vector<BlockSlot>& slots, SliceKind kind);
  template <typename Keep>
  DetachedBlocks describe(const std::vector<BlockSlot>& leaving, SliceKind kind, Keep keep) const;
  DetachedBlocks detach(const std::vector<BlockSlot>& leaving, SliceKind kind,
                        const BlockRegion& region_after);
  void add(BlockSlot slot);
  void remove(const std::vector<BlockSlot>& slots);
  template <typename Predicate>
  void forget_departed_if(Predicate predicate);
  /// Whether a block that left is needed while the volume has this region.
  bool borders_on(const BlockRegion& region, const BlockCoord& coord) const;
  void sort_by_coord(std::vector<BlockSlot>& slots) const;
  static void check_position(const Eigen::Vector3d& position_W);

  Config config_;
  BlockRegion region_;
  BlockTable table_;
  TsdfBlockPool pool_;
  TsdfBlockPool copies_;                  ///< of snapshots: those that end make room for the next
  std::vector<std::uint8_t> in_use_;      ///< by slot: whether it is a block of the volume
  std::vector<std::uint32_t> last_seen_;  ///< by slot: num_moves_ when it was last in view
  std::size_t num_blocks_ = 0;
  std::uint32_t num_moves_ = 0;  ///< calls of shift_to()
  /// Blocks that left and border on the volume, as they were then: extracting the surface between
  /// them and blocks that leave later needs both.
  std::vector<BlockSlot> departed_;
};

}  // namespace kintsugi::mapper

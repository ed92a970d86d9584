#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "mapper/core/slices/block_surface.hpp"
#include "mapper/core/slices/patch_batch.hpp"
#include "mapper/core/slices/tile.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

/// Decides which patches are sent at which frame: those whose surface is no longer what was sent.
///
/// A patch is sent when waiting has cost more than sending costs. The cost of waiting grows with
/// the time and with the share of the patch that is new: one that is all new goes out after
/// new_surface_s, one of which half is new after twice as long. But no new surface waits for longer
/// than longest_wait_s, so that a map is as new at the edge of what was seen before as in its
/// middle. Surface that was sent and has become better since, observed four times as often or moved
/// by a quarter of a voxel, can wait longer: better_surface_s. So a patch that does not change is
/// never sent, and the number of times does not depend on how often the camera looks.
///
/// Where noise alone makes surface come and go, the number of its voxels is random: a standard
/// deviation of it, the root of the patch's voxels, is not new.
///
/// The result depends on the frames alone.
class PatchSchedule {
 public:
  struct Config {
    /// Of device time between two batches. They follow each other quickly enough that new surface
    /// waits for hardly more than it takes to segment it.
    double period_s = 0.2;
    double new_surface_s = 0.15;
    double longest_wait_s = 0.6;  ///< with a batch and the segmenter after it about a second
    double better_surface_s = 10.0;

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  PatchSchedule(const Config& config, const TileGrid& grid, const CrossingRule& rule);

  /// Whether a tile in the volume has surface, or was sent with surface: by the last look at it.
  bool has_surface(const TileCoord& tile) const;

  /// To be called when blocks have left the volume, with their coordinates.
  void note_left(const std::vector<BlockCoord>& left, const TsdfVolume& volume);

  /// To be called when all blocks of an open visit have come back: what was sent of them is up to
  /// date. `keyframe`: at which the tile was seen last.
  void note_returned(const TileCoord& tile, int keyframe, const TsdfVolume& volume);

  /// Ends the visits of all tiles, at once; to be called when the volume is empty. `others`: tiles
  /// that it may not know of.
  PatchBatch depart_all(const std::vector<TileCoord>& others);

  /// The batch of this frame, to be called after it was fused; nothing: none is due. `keyframe`: at
  /// which the camera is.
  std::optional<PatchBatch> next(const TsdfVolume& volume, std::int64_t utime, int keyframe = 0);

 private:
  struct Block {
    BlockSurface sent;
    BlockSurface now;
    BlockChange change;
  };
  struct Tile {
    /// Those that have surface, or had when they were sent. A tile without any still tells where it
    /// was seen, for what will come back.
    std::map<BlockCoord, Block> blocks;
    double debt = 0.0;  ///< cost of waiting over the cost of sending
    int keyframe = 0;   ///< at which it was seen last
  };

  void look_at(const TsdfVolume& volume);
  void forget_discarded(const std::set<TileCoord>& seen, const TsdfVolume& volume);
  double cost_of_waiting(const Tile& tile, double waited_s) const;
  bool is_in_volume(const TileCoord& tile, const TsdfVolume& volume) const;

  const Config config_;
  const TileGrid grid_;
  const CrossingRule rule_;
  std::map<TileCoord, Tile> tiles_;
  /// Tiles without blocks in the volume, since the last batch, and where they were seen last.
  std::map<TileCoord, int> departed_;
  int keyframe_ = 0;                        ///< at the last look at the volume
  std::optional<std::int64_t> last_utime_;  ///< of the last batch that was due
  std::uint32_t num_moves_ = 0;             ///< of the volume at that time
};

}  // namespace kintsugi::mapper

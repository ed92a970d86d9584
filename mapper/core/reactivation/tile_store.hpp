#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "mapper/core/reactivation/kept_block.hpp"
#include "mapper/core/slices/tile.hpp"
#include "mapper/core/slices/tile_visit.hpp"
#include "mapper/core/volume/detached_blocks.hpp"

namespace kintsugi::mapper {

/// Keeps the blocks that have left the volume, by tile, so that they can come back as they were.
///
/// A tile that left for good is closed, and a second visit of the camera makes another one: where
/// tracking had drifted in between, both show the same place with an offset.
///
/// Memory: about a third of the 4 KB of a block. Blocks are packed some time after they came, some
/// of them each frame, so that no frame waits for those of a large slice.
class TileStore {
 public:
  /// Above `max_mb` (1e6 bytes) the visits that were closed longest ago are forgotten.
  TileStore(const TileGrid& grid, double max_mb)
      : grid_(grid), max_bytes_(static_cast<std::size_t>(1e6 * max_mb)) {}

  /// Keeps blocks that have left, in the open visits of their tiles. A block that is there already
  /// is replaced.
  void keep(const DetachedBlocks& left);

  using Blocks = std::map<BlockCoord, std::shared_ptr<KeptBlock>>;
  using BlocksByTile = std::map<TileCoord, Blocks>;

  /// Makes open visits for blocks that will be kept when they are packed. Returns, ascending, the
  /// visits as they are when close() is called next.
  std::vector<TileVisit> expect(const std::vector<BlockCoord>& coords);
  /// May be called on any thread.
  static BlocksByTile packed(const DetachedBlocks& left, const TileGrid& grid);
  /// Keeps blocks in these visits, but not in those that were forgotten.
  void keep(BlocksByTile blocks, const std::vector<TileVisit>& visits);

  /// Closes the open visit of a tile, which was seen last at this keyframe. Also counts the visit
  /// where it has no blocks.
  void close(const TileCoord& tile, int keyframe);

  /// Calls visit(TileVisit, int keyframe) for all tiles that are kept, ascending; the keyframe of
  /// an open one is -1.
  template <typename Visit>
  void for_each(Visit visit) const {
    for (const auto& [key, entry] : entries_) visit(key, entry.keyframe);
  }

  /// The blocks of a visit, ascending.
  std::vector<KeptBlock> blocks_of(const TileVisit& visit) const;

  /// The keyframe of a closed visit; nothing: it is not kept.
  std::optional<int> keyframe_of(const TileVisit& visit) const;

  void forget(const TileVisit& visit);

  using VisitFilter = std::function<bool(const TileVisit&, int keyframe)>;
  /// The block at a place, from a visit of which this is true; of several from the open one, or
  /// else the last. Null: there is none.
  const KeptBlock* find(const BlockCoord& coord, const VisitFilter& is_allowed) const;

  /// The places of a visit's blocks, ascending.
  std::vector<BlockCoord> coords_of(const TileVisit& visit) const;

  /// Packs some of the blocks that wait for it, and forgets visits. To be called once a frame.
  void tidy();

  std::size_t bytes() const { return num_bytes_; }           ///< of the blocks
  std::size_t num_closed() const { return by_age_.size(); }  ///< visits that are kept

 private:
  struct Entry {
    int keyframe = -1;
    std::int64_t age_key = 0;  ///< in by_age_, of a closed one
    Blocks blocks;
  };

  static std::size_t bytes_of(const Blocks& blocks);
  void pack_some();
  void erase(std::map<TileVisit, Entry>::iterator entry);

  const TileGrid grid_;
  const std::size_t max_bytes_;
  std::map<TileVisit, Entry> entries_;
  std::map<std::int64_t, TileVisit> by_age_;  ///< the closed ones, from the one closed first
  std::int64_t next_age_key_ = 0;
  std::size_t num_bytes_ = 0;
  std::map<TileCoord, int> num_closed_;
  std::deque<std::weak_ptr<KeptBlock>> to_pack_;  ///< expired: it has come back
};

}  // namespace kintsugi::mapper

#pragma once
// Surface that has left the volume comes back into it when the camera comes back.

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/reactivation/covered_surface.hpp"
#include "mapper/core/reactivation/kept_block.hpp"
#include "mapper/core/reactivation/tile_store.hpp"
#include "mapper/core/slices/patch_batch.hpp"
#include "mapper/core/slices/tile.hpp"
#include "mapper/core/slices/tile_visit.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

/// Keeps what leaves the volume (a ball), and finds what belongs into it again.
///
/// Where tracking has drifted since a surface was seen, that surface is not where the camera sees
/// it now. So only surface comes back that was seen near on the camera's path: by keyframes that
/// are tracked together. To go over to surface of other keyframes, the camera must be located among
/// those, and the volume must be emptied.
class Reactivation {
 public:
  /// Visits that come back, ascending.
  struct Returned {
    struct Visit {
      TileVisit visit;
      int keyframe = 0;  ///< at which it was seen last
    };
    std::vector<Visit> visits;
    std::vector<KeptBlock> blocks;  ///< of the visits, ascending
    std::vector<KeptBlock> around;  ///< that stay away, but touch these
  };

  Reactivation(const TileGrid& tiles, double max_kept_mb)
      : tiles_(tiles), store_(tiles, max_kept_mb) {}

  /// Keeps blocks that have left the volume.
  void keep(const DetachedBlocks& left) { store_.keep(left); }

  /// To be called with each batch: its patches whose surface has left for good are closed.
  void close_departed(const PatchBatch& batch);

  /// Where what a keyframe saw is, in the frame O in which it was seen: X_OU; nothing: it is near,
  /// and so in the same frame.
  using PlaceOfKeyframe = std::function<std::optional<Pose>(int keyframe)>;

  /// Blocks of the volume that were seen at the same keyframe, and where what others saw is from
  /// there.
  struct SeenBlocks {
    std::vector<BlockCoord> coords;
    PlaceOfKeyframe place_of;
  };

  /// Clears surface of these blocks, which are about to leave, where the same is kept. Of what near
  /// keyframes saw only visits of the same tiles are compared: those that did not come back,
  /// because the volume had surface in their tiles before.
  void clear_known(TsdfVolume& volume, const std::vector<SeenBlocks>& leaving,
                   const SameSurface& same);

  /// The same of all that was in the volume, and keeps the rest. There is much of it, so this is
  /// done on a thread of its own, which also packs the blocks: they are kept from some time after
  /// `utime` on, or from when they are asked for. Returns the rest. `seen`: all blocks of `left`.
  std::shared_future<DetachedBlocks> keep_unknown(DetachedBlocks left,
                                                  const TsdfVolume::Config& volume,
                                                  const std::vector<SeenBlocks>& seen,
                                                  const SameSurface& same, std::int64_t utime);

  /// Of a tile in the volume: whether it has surface.
  using HasSurface = std::function<bool(const TileCoord&)>;

  /// Takes out what a frame is about to change. `is_near`: by keyframe, whether its surface is
  /// where this camera sees it; `keyframe`: at which the camera is. Blocks of the volume that are
  /// in their places have no surface, and are to be replaced.
  Returned take_visible(const SurfaceMap& seen_C, const Pose& X_UC,
                        const std::vector<bool>& is_near, int keyframe, const TsdfVolume& volume,
                        const HasSurface& has_surface);

  /// Whether blocks are kept at most of these places, which near keyframes saw.
  bool has_most_of(const std::vector<BlockCoord>& places, const std::vector<bool>& is_near);

  /// Tiles with an open visit.
  std::vector<TileCoord> open_tiles() const;

  /// To be called once a frame, with its time.
  /// @throws what keep_unknown() threw on its thread
  void tidy(std::int64_t utime);

  std::size_t bytes() const { return store_.bytes(); }  ///< of what is kept

 private:
  /// Visits whose blocks are being packed.
  struct Waiting {
    std::vector<TileVisit> visits;  ///< ascending
    std::future<TileStore::BlocksByTile> blocks;
    std::int64_t due_utime = 0;
  };
  /// A visit of the store, and where its blocks are once they are unpacked.
  struct KnownVisit {
    TileVisit visit;
    std::vector<KeptBlock> packed;
    std::shared_ptr<std::vector<StoredBlock>> blocks;
  };
  struct Known {
    std::vector<BlocksUnderCovers> groups;
    std::vector<KnownVisit> visits;  ///< of the covers, ascending

    std::vector<BlocksUnderCovers> unpacked() &&;
  };

  Known known_in(const std::vector<SeenBlocks>& seen_U, double resolution_m);
  Known find_known(const std::vector<SeenBlocks>& seen_U, double resolution_m) const;
  void settle_near(const std::vector<bool>& is_near);
  void settle();
  Returned take(const std::vector<Returned::Visit>& visits, const std::vector<bool>& is_near,
                const TsdfVolume& volume, const HasSurface& has_surface);
  void add_around(const std::vector<bool>& is_near, const TsdfVolume& volume, Returned& returned);
  Eigen::Vector3d center_of(const TileCoord& tile, double resolution_m) const;
  double radius_m(double resolution_m) const;

  const TileGrid tiles_;
  TileStore store_;
  std::optional<Waiting> waiting_;
};

}  // namespace kintsugi::mapper

#pragma once
// Surface that has left the volume comes back into it when the camera comes back.

#include <cstddef>
#include <functional>
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

  /// Where what a keyframe saw is, in the frame O in which it was seen: X_OU; nothing: it is not
  /// compared, because it is near.
  using PlaceOfKeyframe = std::function<std::optional<Pose>(int keyframe)>;

  /// Clears surface of these blocks, which are about to leave, where the same is kept.
  void clear_known(TsdfVolume& volume, const std::vector<BlockSlot>& leaving,
                   const PlaceOfKeyframe& place_of, const SameSurface& same) const;

  /// Takes out what a frame is about to change. `is_near`: by keyframe, whether its surface is
  /// where this camera sees it; `keyframe`: at which the camera is.
  Returned take_visible(const SurfaceMap& seen_C, const Pose& X_UC,
                        const std::vector<bool>& is_near, int keyframe, const TsdfVolume& volume);

  /// Whether blocks are kept at most of these places, which near keyframes saw.
  bool has_most_of(const std::vector<BlockCoord>& places, const std::vector<bool>& is_near) const;

  /// Tiles with an open visit.
  std::vector<TileCoord> open_tiles() const;

  /// To be called once a frame.
  void tidy() { store_.tidy(); }

  std::size_t bytes() const { return store_.bytes(); }  ///< of what is kept

 private:
  Returned take(const std::vector<Returned::Visit>& visits, const std::vector<bool>& is_near,
                const TsdfVolume& volume);
  void add_around(const std::vector<bool>& is_near, const TsdfVolume& volume, Returned& returned);
  Eigen::Vector3d center_of(const TileCoord& tile, double resolution_m) const;
  double radius_m(double resolution_m) const;

  const TileGrid tiles_;
  TileStore store_;
};

}  // namespace kintsugi::mapper

#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "mapper/core/extraction/mesh_extractor.hpp"
#include "mapper/core/extraction/surface_extractor.hpp"
#include "mapper/core/loop_closure/map_deformation.hpp"
#include "mapper/core/slices/common_surface.hpp"
#include "mapper/core/slices/guest_patch.hpp"
#include "mapper/core/slices/patch_batch.hpp"
#include "mapper/core/slices/patch_run.hpp"
#include "mapper/core/slices/tile.hpp"
#include "mapper/core/slices/tile_visit.hpp"

namespace kintsugi::mapper {

/// Makes the patches of a map: numbers them, counts their revisions, and keeps the surface that has
/// left the volume until the last of its tile has left.
///
/// A patch has the surface of its tile that has left, as it was extracted when it left, and then
/// that which is in the volume. So the last revisions of all patches together are the slices that
/// left the volume, point for point. When the volume comes back to a tile that had left it for
/// good, there is another patch, unless the blocks of the first one come back: then that goes on,
/// and what was given of it before, by keep(), counts no more.
///
/// Where guests have surface of the same places, each point is in one patch only (CommonSurface).
class PatchMaker {
 public:
  /// @param common patches are sent without surface that others have better; nothing: as they are
  explicit PatchMaker(const TileGrid& grid,
                      const std::optional<CommonSurface::Config>& common = std::nullopt)
      : grid_(grid), common_(common ? std::optional<CommonSurface>(*common) : std::nullopt) {}

  /// Takes surface that has left the volume. Returns the patches of its points. A patch that was
  /// never sent was seen where the camera is: `seen_at`.
  std::vector<PatchRun> keep(const ExtractedSurface& left, const SeenAt& seen_at = {});

  /// The patches of the vertices of a mesh: that of the tile in which each one is, as it is now or
  /// was when it left.
  std::vector<PatchRun> patches_of(const MeshPiece& piece, double resolution_m);

  /// Continues the patches of visits that are in the volume again, with all their blocks. Where
  /// there was another patch until now, which has no surface any more, it ends: gives its last
  /// revision. `header` as for make().
  std::vector<CloudSlice> reopen(std::span<const TileVisit> visits, const CloudSlice& header,
                                 const SeenAt& seen_at = {});

  /// Where a patch was sent to, by its number in PatchRun; nothing: the points with this number
  /// count no more.
  std::optional<PatchPlace> place_of(int patch) const;

  /// The patches of a batch; `in_volume` has the surface of their tiles that is in the volume.
  /// `header` has the fields that are the same in all of them. A patch that never had points is
  /// left out. Once a second of the headers' time those follow of which others have surface by now,
  /// or no more.
  std::vector<CloudSlice> make(const PatchBatch& batch, const ExtractedSurface& in_volume,
                               const CloudSlice& header);

  /// Takes patches of guests: each gets a number here, with which it is revised and corrected like
  /// the others. `header` as for make().
  std::vector<CloudSlice> take_in(std::vector<GuestPatch> patches, const CloudSlice& header);

  /// Moves the patches with the keyframes at which they were seen. Gives a correction slice for
  /// each part of the map with those that move by more than a tenth of a voxel; nothing where none
  /// does. `X_WU_now` is where what the camera sees now has moved to.
  std::vector<CloudSlice> correct(const MapDeformation& deformation, const CloudSlice& header,
                                  const Pose& X_WU_now = Pose::Identity());

  /// The last revision of every patch that is not departed, in batches that are a microsecond
  /// apart, and the final slice.
  std::vector<CloudSlice> finish(const CloudSlice& header);

  /// How many have a place in the map, departed or not. Those that ended are forgotten, and those
  /// that departed before they had points.
  std::size_t num_placed() const { return places_.size(); }

 private:
  static constexpr std::int32_t kNoId = -1;
  static constexpr std::int32_t kNotOfCamera = -1;  ///< CloudSlice::keyframe of a guest's patch
  struct Patch {
    int number = kNoPatch;           ///< of its place
    std::vector<CloudPoint> left_W;  ///< points that have left the volume
  };

  /// Where the points of a guest's patch are. Those of this mapper are in U and their tile.
  struct GuestFrame {
    std::int64_t session = 0;
    Pose X_UP;
    Eigen::AlignedBox3d box_P;  ///< holds the points, metres
  };

  /// Where a patch was sent to, whether it is departed or not.
  struct Place {
    TileCoord tile;  ///< of one of this mapper
    std::optional<GuestFrame> guest = {};
    std::int32_t id = kNoId;
    std::int32_t revision = -1;  ///< the last one
    bool in_volume = false;      ///< as of that; of a guest's patch, in the guest's
    int keyframe = 0;            ///< with which it moves
    PatchPose X_WP = {};
    int part = 0;  ///< of the map
    bool has_vertices = false;
  };

  std::map<TileCoord, std::vector<CloudPoint>> by_tile(const ExtractedSurface& surface) const;
  Patch& patch_at(const TileCoord& tile, const SeenAt& seen_at);
  void go_on(Patch& patch, const TileVisit& visit);
  void close(const TileCoord& tile);
  std::vector<CloudSlice> revisions_of(const PatchBatch& batch, const ExtractedSurface& in_volume,
                                       const CloudSlice& header);
  void end(int number);
  void give_id(int number);
  static CommonSurface::Name name_of(const Place& place);
  CloudSlice revision_of(Place& place, std::vector<CloudPoint> points_P, const CloudSlice& header);
  CloudSlice slice_of(Place& place, std::vector<CloudPoint> points_P, const CloudSlice& header);
  std::vector<CloudSlice> revisions_of(std::vector<CommonSurface::Rest> patches,
                                       const CloudSlice& header);
  std::vector<CommonSurface::Rest> changed_by_others(std::int64_t utime);
  static PatchPose pose_of(const Place& place, const Pose& X_WU);
  Eigen::AlignedBox3d box_P(const Place& place, double resolution_m) const;

  const TileGrid grid_;
  std::map<int, Place> places_;  ///< by the number of the patch
  int next_number_ = 0;
  std::map<TileCoord, int> newest_;            ///< the number of the newest patch of each tile
  std::map<std::int32_t, int> number_of_id_;   ///< of those that have an id
  std::map<TileVisit, int> closed_;            ///< the numbers of those that may be reopened
  std::map<TileCoord, int> num_closed_;        ///< visits, those that were reopened as well
  std::int32_t correction_ = 0;                ///< number of the last one
  std::map<TileCoord, Patch> patches_;         ///< that the volume may still change
  std::map<GuestPatch::Name, int> of_guests_;  ///< the numbers of their patches
  std::optional<CommonSurface> common_;
  std::int64_t common_due_utime_ = 0;  ///< when to look at it again
  std::int32_t next_id_ = 0;
  std::int64_t revision_sum_ = 0;  ///< of the newest revisions
};

}  // namespace kintsugi::mapper

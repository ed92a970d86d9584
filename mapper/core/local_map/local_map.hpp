#pragma once
// The map around the camera, which still changes, and what has left it.

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/trajectory.hpp"
#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/loop_closure/loop_closure.hpp"
#include "mapper/core/reactivation/covered_surface.hpp"
#include "mapper/core/reactivation/reactivation.hpp"
#include "mapper/core/slices/guest_patch.hpp"
#include "mapper/core/slices/patch_schedule.hpp"
#include "mapper/core/slices/slice_worker.hpp"
#include "mapper/core/slices/tile.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

/// A volume that moves with the camera; what has left it, which comes back where the camera does;
/// and the slices that are made of both.
///
/// U is the uncorrected map, in which the camera is tracked and the volume is; W the corrected one,
/// in which slices tell where they are. `camera_U` is where the camera was tracked last, with the
/// time of the present frame.
///
/// Of patches each may move with the keyframe at which it was seen. Without loop closure nothing
/// moves or comes back, and what counts as a keyframe here is a part of the map.
class LocalMap {
 public:
  struct Config {
    TsdfVolume::Config volume;
    /// Where the camera comes back to a place, what it sees is the surface that is there.
    SameSurface same_surface;  ///< its weight threshold follows from the extractor
    /// What this camera has seen is sent also where a guest has seen it better: to another mapper,
    /// whose map this one joins, and which knows nothing of the guests.
    bool keeps_own_surface = false;
    /// Of surface that has left and may come back, 1e6 bytes; above that what left longest ago is
    /// forgotten. A metre of a walk through rooms takes 5 MB.
    double max_kept_mb = 1000.0;
    SliceWorker::Config slices;  ///< its `tiles` and `common_surface` follow from the rest
    /// The map comes in patches of about this size, m, while its surface is in the volume; 0: in
    /// slices, when it leaves the volume.
    double patch_side_m = 0.0;
    PatchSchedule::Config patch_schedule;

    /// @throws std::invalid_argument naming field, value and bound
    void validate_map() const;
  };

  /// @param loops of this map, which outlives this object; null: loops are not closed
  /// @throws std::invalid_argument if the configuration is not valid
  LocalMap(const Config& config, const LoopClosure* loops);

  TsdfVolume& volume() { return volume_; }
  const TsdfVolume& volume() const { return volume_; }
  /// What the volume can hold; of a ball everything, as it holds all that is measured.
  Eigen::AlignedBox3d region_U() const;

  /// The part of the map in which the camera is tracked.
  int part() const { return part_; }
  /// At which keyframe the camera is, and where that is by now.
  SeenAt camera_at() const;
  /// Where what was seen at a keyframe is by now.
  MapDeformation::Place place_of(int keyframe) const;

  /// Moves with the camera, before a frame is fused. What the camera saw long ago leaves. Returns
  /// how many slices that makes.
  int follow(const StampedPose& camera_U);

  /// What this frame is about to change comes back.
  void bring_back_visible(const SurfacePyramid& seen_C, const StampedPose& camera_U);

  /// Sends the patches whose surface is no longer what was sent, after a frame was fused.
  void send_due(const StampedPose& camera_U);
  /// Sends patches of guests.
  void send(std::vector<GuestPatch> patches, const StampedPose& camera_U);
  /// Sends where patches are after a correction.
  void send_correction(const StampedPose& camera_U);

  /// Whether what has left comes back.
  bool keeps_what_left() const { return reactivation_.has_value(); }
  /// Whether most of what a keyframe saw may come back.
  bool keeps_most_of(const Keyframe& keyframe, const std::vector<bool>& is_near);

  /// Everything leaves the volume, because the camera is going over to surface that is kept.
  void leave(const StampedPose& camera_U);
  /// After that: the camera is at this keyframe, and what it sees there comes back.
  void arrive(int keyframe, const SurfacePyramid& seen_C, const StampedPose& camera_U);

  /// Another part of the map begins, in which the camera is at its origin; what it saw before
  /// leaves the volume.
  void begin_part(int part, const StampedPose& camera_U);

  /// Slices that are finished since the last call.
  std::vector<CloudSlice> take_finished() { return slice_worker_.take_finished(); }
  /// The end of the run: all that is left, the final slice at last.
  std::vector<CloudSlice> finish(const StampedPose& camera_U);

  /// See SliceWorker.
  std::optional<PatchPlace> place_of_patch(int patch) const {
    return slice_worker_.place_of_patch(patch);
  }
  double extraction_ms() const { return slice_worker_.busy_ms(); }
  /// Of what has left and may come back.
  std::size_t kept_bytes() const { return reactivation_ ? reactivation_->bytes() : 0; }

 private:
  SliceCamera slice_camera(const StampedPose& camera_U) const;
  int shift(const Eigen::Vector3d& center_U, const StampedPose& camera_U);
  int let_go_of_far_surface(const StampedPose& camera_U);
  void take_left(DetachedBlocks left, const StampedPose& camera_U);
  void clear_known(const std::vector<BlockSlot>& leaving);
  int keyframe_seen_at(BlockSlot slot) const;
  std::vector<Reactivation::SeenBlocks> by_keyframe(const std::vector<BlockSlot>& slots) const;
  Reactivation::PlaceOfKeyframe places_of_keyframes_far_from(int keyframe) const;
  std::vector<BlockSlot> slots_of(const std::function<bool(BlockSlot)>& is_chosen) const;
  void restore(const Reactivation::Returned& returned, const StampedPose& camera_U);
  void depart_all(const StampedPose& camera_U);
  void send(PatchBatch batch, const StampedPose& camera_U);

  const Config config_;
  const LoopClosure* const loops_;
  TsdfVolume volume_;
  const TileGrid tiles_;
  std::optional<PatchSchedule> patch_schedule_;  ///< none: slices
  std::optional<Reactivation> reactivation_;     ///< none: what has left does not come back
  /// By TsdfVolume::num_moves(): at which keyframe the camera was.
  std::vector<int> keyframe_at_move_;
  int part_ = 0;
  SliceWorker slice_worker_;
};

}  // namespace kintsugi::mapper

#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "lcmtypes/scene/up_direction.hpp"
#include "viewer/core/map/camera_track.hpp"
#include "viewer/core/map/label_update.hpp"
#include "viewer/core/map/map_slice.hpp"
#include "viewer/core/map/pending_updates.hpp"
#include "viewer/core/map/point_chunk.hpp"
#include "viewer/core/map/slice_revisions.hpp"

namespace kintsugi::viewer {

/// Points that are shown now.
struct PointCounts {
  std::int64_t shown = 0;
  std::int64_t in_volume = 0;  ///< of these: may still change
};

/// What a ReceivedMap holds now, and what it has been given since it began.
struct MapCounts {
  std::int64_t slices = 0;           ///< held now
  std::int64_t points = 0;           ///< shown now
  std::int64_t labelled_slices = 0;  ///< held now, their newest revision with its update applied
  std::int64_t segments = 0;         ///< in the whole map, according to the newest update

  std::int64_t updates = 0;           ///< applied, or kept until their slice arrives
  std::int64_t repeated_updates = 0;  ///< said nothing new
  std::int64_t labellings = 0;        ///< slices that got their first update, each revision counted
  std::int64_t ignored_slices = 0;    ///< repeated, or of an earlier revision than the one held
  std::int64_t ignored_updates = 0;   ///< of another map, an earlier segmenter or earlier revision
  std::int64_t ignored_runs = 0;      ///< outside their slice, or no memory to keep them
};

/// The slices of one map session, where corrections have moved them, their labels and the camera's
/// path, as far as they have arrived.
///
/// Slices and updates may arrive in any order and more than once; the result is the same. A higher
/// revision of a slice replaces points and labels of the one held: if that has labels, not before
/// the labels of the higher one are here, so that no surface loses its segments for a moment.
/// Labels for a revision that has not arrived are kept until it does; labels for one that has been
/// replaced are ignored. The full state that a segmenter sends to late joiners changes nothing in a
/// map that is up to date. The cost of a message does not grow with the map.
///
/// The map may have several parts (CloudSlice::part), far apart in W: a picture shows one of them.
/// A correction brings patches from one part into another. Camera poses stay in the part in which
/// they were received: where they are in another part is not known.
///
/// A segmenter session with a larger number replaces the one before, after a restart. The old
/// labels remain visible until the new ones arrive, slice by slice, but slices with old labels
/// count as unlabelled.
class ReceivedMap {
 public:
  explicit ReceivedMap(std::int64_t map_session) : map_session_(map_session) {}

  /// Adds a slice or a revision of one. False when the revision is not newer than the newest held:
  /// ignored and counted.
  bool add_slice(CloudSlice slice);

  /// Applies the labels and runs of an update; false when it changed nothing. Ignored and counted
  /// are updates of another map session, of an earlier segmenter session than the newest, and with
  /// a sequence number of 2^32 - 1 or more: no stream is that long.
  bool apply_update(const SegmentUpdate& update);

  /// Shows the newest revision of every slice, with or without labels, and removes the labels of
  /// earlier segmenters that the present one has not replaced.
  void settle();

  /// False when the pose is not used: camera lost or starting, or not newer than the last pose.
  bool add_pose(const CameraPose& pose);

  /// Something of the map has this device time.
  void note_time(std::int64_t utime);

  std::int64_t map_session() const { return map_session_; }
  const MapCounts& counts() const { return counts_; }
  /// Slices without their update, plus slices (or newer revisions of them) that have not arrived
  /// although an update or the final slice has named them. 0: with the final slice, the map is
  /// complete.
  std::int64_t lag_slices() const;
  /// Newest device time heard of, microseconds; 0 when there is none.
  std::int64_t utime() const { return utime_.value_or(0); }
  /// Earliest device time heard of, microseconds; 0 when there is none.
  std::int64_t first_utime() const { return first_utime_.value_or(0); }
  /// The segmenter has sent the update that completes its map.
  bool final_update_seen() const { return final_update_seen_; }

  const MapSlice* slice(std::int32_t id) const;  ///< as it is shown; nullptr: not here

  /// Calls function(const MapSlice&) for every slice as it is shown, by ascending id.
  template <class Function>
  void for_each_shown(Function&& function) const {
    for (const auto& [id, slice] : slices_) function(slice.shown());
  }

  /// The parts that have points.
  std::set<std::int32_t> parts() const;
  /// The part in which the camera is, according to the newest pose; as long as that part has no
  /// points, or no pose is known, newest_part().
  std::int32_t camera_part() const;
  /// The part of the newest slice with points, the same in every viewer with all slices; 0 when no
  /// slice has points.
  std::int32_t newest_part() const;

  // Of one part of the map:
  std::vector<PointChunk> chunks(std::int32_t part) const;  ///< as they are shown, by slice id
  PointCounts points(std::int32_t part) const;
  const UpDirection& up(std::int32_t part) const;
  /// The path through the poses received, and those that came with slices in gaps between them.
  CameraTrack received_track(std::int32_t part) const;
  /// The path through the poses that came with slices: the same in every viewer with all slices.
  CameraTrack slice_track(std::int32_t part) const;

 private:
  static constexpr std::size_t kMaxPendingBytes = std::size_t{1} << 29U;  ///< 130 million labels

  /// What is shown of one part.
  struct Part {
    PointCounts points;
    UpDirection up;
    std::vector<LoopLink> loops;
    std::int32_t loops_correction = 0;  ///< the correction that told them
  };

  /// What the final slice tells of the whole map.
  struct Announcement {
    std::int32_t id = 0;
    std::int64_t revision_sum = 0;
  };

  bool is_replaced(SliceKey key) const;
  MapSlice* find(SliceKey key);
  bool accept_segmenter(std::int64_t session);
  void await_new_segmenter();
  bool use_counts(const SegmentUpdate& update, std::uint32_t number);
  UpdateEffect use_labels(SliceKey key, NumberedLabels labels);
  bool use_run(const NumberedRun& run);
  UpdateEffect apply_labels(MapSlice& slice, const NumberedLabels& labels);
  bool apply_run(MapSlice& slice, const NumberedRun& run);
  void apply_pending(MapSlice& slice);
  void advance(SliceRevisions& slice);
  void note_shown(const MapSlice& slice);
  void note_hidden(const MapSlice& slice);
  bool has_points(std::int32_t part) const { return points(part).shown > 0; }
  void note_final(const CloudSlice& slice);
  void move_patches(const CloudSlice& correction);
  void note_loops(const CloudSlice& correction);
  std::vector<LoopLink> loops(std::int32_t part) const;
  std::vector<TimedPose> slice_poses(std::int32_t part) const;

  std::int64_t map_session_;
  std::int64_t segmenter_session_ = 0;
  std::map<std::int32_t, SliceRevisions> slices_;
  PatchMotions motions_;
  PendingUpdates pending_{kMaxPendingBytes};
  std::optional<std::uint32_t> newest_update_;
  std::int64_t announced_slices_ = 0;  ///< slices in the map, according to the segmenter
  bool final_update_seen_ = false;
  std::optional<Announcement> final_slice_;
  std::int64_t revision_sum_ = 0;  ///< of the newest revisions held
  MapCounts counts_;
  std::optional<std::int64_t> utime_;
  std::optional<std::int64_t> first_utime_;
  std::map<std::int32_t, Part> parts_;           // by number
  std::map<std::int32_t, ReceivedPoses> poses_;  // by part
};

}  // namespace kintsugi::viewer

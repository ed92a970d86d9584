#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "viewer/core/scene/camera_track.hpp"
#include "viewer/core/scene/pending_updates.hpp"
#include "viewer/core/scene/up_direction.hpp"

namespace kintsugi::viewer {

/// Points that are drawn or culled together. Views into a Scene: valid until it changes.
struct PointChunk {
  std::span<const CloudPoint> points_W;
  std::span<const std::uint32_t> labels;  ///< segment id of each point; kNoSegment: none yet
  Eigen::AlignedBox3f box_W;              ///< of the points, metres
  float resolution_m = 0.0F;              ///< voxel size the points were taken from
};

/// One slice of the map with the labels that it has so far.
struct SceneSlice {
  std::int64_t utime = 0;
  std::int32_t id = 0;
  std::int32_t revision = 0;
  bool labelled = false;      ///< the update of this slice has been applied
  bool was_labelled = false;  ///< it, or that of an earlier segmenter
  float resolution_m = 0.0F;
  Pose X_WC = Pose::Identity();
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> labels;
  std::vector<std::uint32_t> label_updates;      ///< 1 + number of the update behind each label
  std::vector<Eigen::AlignedBox3f> chunk_boxes;  ///< of each kChunkPoints points, W
};

/// What was put into a scene and what could not be used; all since the scene began.
struct SceneCounts {
  std::int64_t slices = 0;            ///< present now
  std::int64_t points = 0;            ///< present now
  std::int64_t segments = 0;          ///< as the newest update says
  std::int64_t updates = 0;           ///< applied, or kept until their slice arrives
  std::int64_t repeated_updates = 0;  ///< said nothing new
  std::int64_t labelled_slices = 0;   ///< present now, with their update applied
  std::int64_t labellings = 0;        ///< slices that got their first update, each revision counted
  std::int64_t ignored_slices = 0;    ///< repeated, or older than what is shown
  std::int64_t ignored_updates = 0;   ///< of another map, of a superseded segmenter or revision
  std::int64_t ignored_runs = 0;      ///< reach outside their slice, or wait for too many
};

/// The map as far as it is known: slices, their labels and the camera's path, of one map session.
///
/// Slices and updates may arrive in any order and more than once. A higher revision of a slice
/// takes the place of the one here, points and labels. Every point remembers the sequence number of
/// the update that labelled it, and a lower one never overrides a higher one, so the labels after a
/// set of updates are those of the updates applied in their order. What an update says about a
/// revision of a slice that is not here yet waits for it; about one that has been replaced it means
/// nothing. A segmenter that describes its whole map again, for someone who came late, changes
/// nothing here.
///
/// A segmenter session with a larger number takes the place of the one before: the map keeps the
/// labels it has until the new ones come, slice by slice, but they count no more.
class Scene {
 public:
  /// Points of one PointChunk; a power of two, so that a point's number splits by shifting.
  static constexpr std::size_t kChunkPoints = 4096;

  explicit Scene(std::int64_t map_session) : map_session_(map_session) {}

  /// Adds a slice, or replaces an earlier revision of it; its labels then start anew. False when
  /// the revision is not newer than the one present: ignored and counted.
  bool add_slice(CloudSlice slice);

  /// Applies the labels and runs of an update; false when it changed nothing. Updates of an earlier
  /// segmenter session than the newest are ignored and counted, and so is a sequence number beyond
  /// 2^32: no stream is that long.
  bool apply_update(const SegmentUpdate& update);

  /// Takes away the labels of earlier segmenters that the present one has not replaced.
  void discard_old_labels();

  /// Moves the camera. False when the pose is of no use: lost, starting, not newer.
  bool add_pose(const CameraPose& pose);

  std::int64_t map_session() const { return map_session_; }
  const SceneCounts& counts() const { return counts_; }
  /// Slices here that wait for their update, and slices, or newer revisions of them, that an update
  /// has named but are not here.
  std::int64_t lag_slices() const;
  /// Device time of the newest slice or pose, microseconds; 0 when there is none.
  std::int64_t utime() const { return utime_.value_or(0); }
  /// Device time of the earliest slice or pose, microseconds; 0 when there is none.
  std::int64_t first_utime() const { return first_utime_.value_or(0); }
  /// The segmenter has said that its map is complete.
  bool final_update_seen() const { return final_update_seen_; }
  /// Slices that the segmenter has counted.
  std::int64_t announced_slices() const { return announced_slices_; }

  const SceneSlice* slice(std::int32_t id) const;  ///< nullptr: not here
  /// The last slice that has been segmented; with no segmenter, the last slice. Slices without
  /// points are passed over. nullptr: none.
  const SceneSlice* newest_slice() const;

  std::vector<PointChunk> chunks() const;  ///< of the whole map, by slice id
  std::vector<PointChunk> chunks(const SceneSlice& slice) const;

  Eigen::AlignedBox3f box_W() const;  ///< of all points, metres; empty when there are none
  const UpDirection& up() const { return up_; }

  /// From the poses heard, and those that came with the slices where none was heard.
  CameraTrack heard_track() const { return poses_.track(slice_poses()); }
  /// From the poses that came with the slices: the same for everyone who has the map.
  CameraTrack slice_track() const { return track_through(slice_poses()); }

  std::int64_t memory_bytes() const;

 private:
  static constexpr std::size_t kMaxPendingBytes = std::size_t{1} << 29U;  ///< 130 million labels

  enum class Presence { kHere, kReplaced, kNotYet };
  enum class Effect { kIgnored, kNothingNew, kNews };

  Presence presence(SliceKey key) const;
  bool accept_segmenter(std::int64_t session);
  void expect_labels_anew();
  bool use_counts(const SegmentUpdate& update, std::uint32_t number);
  Effect use_labels(SliceKey key, PendingUpdates::Labels labels);
  bool use_run(const PendingUpdates::Run& run);
  Effect apply_labels(SceneSlice& slice, const PendingUpdates::Labels& update);
  bool apply_run(SceneSlice& slice, const PendingUpdates::Run& update);
  void apply_pending(SceneSlice& slice);
  std::vector<TimedPose> slice_poses() const;
  void advance_time(std::int64_t utime);

  std::int64_t map_session_;
  std::int64_t segmenter_session_ = 0;
  std::map<std::int32_t, SceneSlice> slices_;
  PendingUpdates pending_{kMaxPendingBytes};
  std::optional<std::uint32_t> newest_update_;
  std::int64_t announced_slices_ = 0;
  bool final_update_seen_ = false;
  SceneCounts counts_;
  std::optional<std::int64_t> utime_;
  std::optional<std::int64_t> first_utime_;
  UpDirection up_;
  HeardPoses poses_;
};

}  // namespace kintsugi::viewer

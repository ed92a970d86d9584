#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "viewer/core/up_direction.hpp"

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
  bool labelled = false;  ///< the update of this slice has been applied
  float resolution_m = 0.0F;
  Pose X_WC = Pose::Identity();
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> labels;
  std::vector<std::uint32_t> label_updates;      ///< 1 + number of the update behind each label
  std::vector<Eigen::AlignedBox3f> chunk_boxes;  ///< of each kChunkPoints points, W
};

/// What was put into a scene and what could not be used; all since the scene began.
struct SceneCounts {
  std::int64_t slices = 0;           ///< present now
  std::int64_t points = 0;           ///< present now
  std::int64_t segments = 0;         ///< as the newest update says
  std::int64_t updates = 0;          ///< applied, or kept until their slice arrives
  std::int64_t labelled_slices = 0;  ///< present now, with their update applied
  std::int64_t labellings = 0;       ///< slices that got their update, each revision counted
  std::int64_t ignored_slices = 0;   ///< repeated, or older than what is shown
  std::int64_t ignored_updates = 0;  ///< of another map, of a superseded segmenter or revision
  std::int64_t ignored_runs = 0;     ///< reach outside their slice, or wait for too many
};

/// The map as far as it is known: slices, their labels and the camera's path, of one map session.
///
/// Slices and updates may arrive in any order and more than once. A higher revision of a slice
/// takes the place of the one here, points and labels. Every point remembers the sequence number of
/// the update that labelled it, and a lower one never overrides a higher one, so the labels after a
/// set of updates are those of the updates applied in their order. What an update says about a
/// revision of a slice that is not here yet waits for it; about one that has been replaced it means
/// nothing.
class Scene {
 public:
  /// Points of one PointChunk; a power of two, so that a point's number splits by shifting.
  static constexpr std::size_t kChunkPoints = 4096;

  explicit Scene(std::int64_t map_session) : map_session_(map_session) {}

  /// Adds a slice, or replaces an earlier revision of it; its labels then start anew.
  /// A revision that is not newer than the one present is ignored and counted.
  void add_slice(CloudSlice slice);

  /// Applies the labels and runs of an update. The first update of a segmenter session not seen
  /// before discards the labels of the session before it, whose later updates are ignored and
  /// counted. So is a sequence number beyond 2^32: no stream is that long.
  void apply_update(const SegmentUpdate& update);

  /// Moves the camera; its path grows by each kPathStep_m. Lost and starting frames move nothing.
  void add_pose(const CameraPose& pose);

  std::int64_t map_session() const { return map_session_; }
  const SceneCounts& counts() const { return counts_; }
  /// Slices here that wait for their update, and slices, or newer revisions of them, that an update
  /// has named but are not here.
  std::int64_t lag_slices() const;
  /// Device time of the newest slice or pose, microseconds; 0 when there is none.
  std::int64_t utime() const { return utime_; }
  /// Device time of the first slice or pose, microseconds; 0 when there is none.
  std::int64_t first_utime() const { return first_utime_; }
  /// The segmenter has said that its map is complete.
  bool final_update_seen() const { return final_update_seen_; }
  /// Slices that the newest update counted.
  std::int64_t announced_slices() const { return announced_slices_; }

  const SceneSlice* slice(std::int32_t id) const;  ///< nullptr: not here
  /// The slice that was segmented last; with no segmenter, the last slice. Slices without points
  /// are passed over. nullptr: none.
  const SceneSlice* newest_slice() const;

  std::vector<PointChunk> chunks() const;  ///< of the whole map, by slice id
  std::vector<PointChunk> chunks(const SceneSlice& slice) const;

  Eigen::AlignedBox3f box_W() const;  ///< of all points, metres; empty when there are none
  const UpDirection& up() const { return up_; }
  const std::vector<Eigen::Vector3f>& path_W() const { return path_W_; }
  const std::optional<Pose>& X_WC() const { return X_WC_; }  ///< of the newest frame

  std::int64_t memory_bytes() const;

 private:
  struct SliceKey {
    std::int32_t id = 0;
    std::int32_t revision = 0;
    bool operator<(const SliceKey& other) const {
      return std::tie(id, revision) < std::tie(other.id, other.revision);
    }
  };
  struct PendingRun {
    LabelRun run;
    std::uint32_t number = 0;  ///< of its update
  };
  struct PendingLabels {
    std::vector<std::uint32_t> labels;
    std::uint32_t number = 0;
  };
  struct Pending {
    std::optional<PendingLabels> labels;
    std::vector<PendingRun> runs;
  };

  static constexpr double kPathStep_m = 0.02;
  static constexpr std::size_t kMaxPendingRuns = 4'000'000;  ///< 96 MB: hostile or hopeless

  enum class Presence { kHere, kReplaced, kNotYet };

  Presence presence(SliceKey key) const;
  bool accept_segmenter(std::int64_t session);
  void use_labels(SliceKey key, PendingLabels labels);
  void use_run(const PendingRun& pending);
  void apply_labels(SceneSlice& slice, const PendingLabels& pending);
  void apply_run(SceneSlice& slice, const PendingRun& pending);
  void apply_pending(SceneSlice& slice);
  void ignore_counted_update();
  std::int64_t superseded_slices() const;
  void discard_labels();
  void advance_time(std::int64_t utime);

  std::int64_t map_session_;
  std::int64_t segmenter_session_ = 0;
  std::vector<std::int64_t> superseded_segmenters_;
  std::map<std::int32_t, SceneSlice> slices_;
  std::map<SliceKey, Pending> pending_;  ///< what waits for points
  std::size_t pending_runs_ = 0;
  std::optional<std::uint32_t> newest_update_;
  std::int32_t newest_labelled_id_ = -1;
  std::int64_t announced_slices_ = 0;
  bool final_update_seen_ = false;
  SceneCounts counts_;
  std::int64_t utime_ = 0;
  std::int64_t first_utime_ = 0;
  UpDirection up_;
  std::vector<Eigen::Vector3f> path_W_;
  std::optional<Pose> X_WC_;
};

}  // namespace kintsugi::viewer

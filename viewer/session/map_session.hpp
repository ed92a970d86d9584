#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lcmtypes/messages.hpp"
#include "viewer/core/camera/smoothed_camera.hpp"
#include "viewer/core/map/received_map.hpp"
#include "viewer/core/map/update_log.hpp"
#include "viewer/core/rendering/highlight.hpp"
#include "viewer/session/run_history.hpp"

namespace kintsugi::viewer {

/// Everything received of one map session, and which pictures of it are due. Times `now_s` are
/// those of a PatientClock.
class MapSession {
 public:
  /// `keep_updates`: fill updates(), which takes memory for every segment that changes.
  MapSession(std::int64_t map_session, double now_s, bool keep_updates = false)
      : map_(map_session), keep_updates_(keep_updates), last_change_s_(now_s) {}

  void use(CloudSlice slice, double now_s);
  void use(const SegmentUpdate& update, double now_s);
  void use(const CameraPose& pose);
  void use(const SegmenterStatus& status) { history_.add_slice_time(status); }
  /// Highlights the segments of the answer, if it is the newest by its time and has no problem.
  void use(const SegmentAnswer& answer);

  const ReceivedMap& map() const { return map_; }
  const SmoothedCamera& depth_camera() const { return depth_camera_; }
  RunHistory& history() { return history_; }
  const UpdateLog& updates() const { return updates_; }
  bool is_empty() const { return map_.counts().slices == 0; }

  /// The segmenter has completed its map, and all of it has arrived.
  bool is_complete() const { return map_.final_update_seen() && map_.lag_slices() == 0; }
  /// Nothing has changed for kSilence_s.
  bool is_silent(double now_s) const { return now_s - last_change_s_ >= kSilence_s; }

  /// True when `every_slices` more slices are visible than in the last snapshot. Slices count when
  /// they get their labels, corrected ones again; without a segmenter, when they arrive.
  bool snapshot_is_due(int every_slices) const;
  void note_snapshot() { counts_at_snapshot_ = map_.counts(); }

  /// The segments of the newest answer of the segmenter; empty when there are none.
  const Highlight& answered() const { return answered_; }
  bool answer_is_due() const { return is_answer_new_ && !is_empty(); }
  void note_answer() { is_answer_new_ = false; }

  /// True when `period_s` of map time have passed since the last frame of the video.
  bool frame_is_due(double period_s) const;
  void note_frame() { last_frame_utime_ = map_.utime(); }

  /// The final pictures with this suffix in their names do not exist or are out of date.
  bool final_is_due(const std::string& suffix) const {
    return !is_empty() && final_suffix_ != suffix;
  }
  /// Call before the final pictures are drawn: removes labels of earlier segmenters.
  void prepare_final() { map_.discard_old_labels(); }
  void note_final(const std::string& suffix) { final_suffix_ = suffix; }

 private:
  static constexpr double kSilence_s = 5.0;

  void note_change(double now_s);

  ReceivedMap map_;
  SmoothedCamera depth_camera_;
  RunHistory history_;
  bool keep_updates_;
  UpdateLog updates_;
  double last_change_s_;
  MapCounts counts_at_snapshot_;
  Highlight answered_;
  std::int64_t answer_utime_ = 0;
  bool is_answer_new_ = false;
  std::optional<std::int64_t> last_frame_utime_;
  std::optional<std::string> final_suffix_;  // of the final pictures that are up to date
};

}  // namespace kintsugi::viewer

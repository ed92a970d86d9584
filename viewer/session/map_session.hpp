#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/client/event_table.hpp"
#include "lcmtypes/messages.hpp"
#include "viewer/core/camera/smoothed_camera.hpp"
#include "viewer/core/figure/object_boxes.hpp"
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
  void use(CameraView view);
  void use(const SegmenterStatus& status) { history_.add_slice_time(status); }
  /// Highlights the segments of the answer, if it is the newest by its time, has no problem, and is
  /// not about views.
  void use(const SegmentAnswer& answer);
  void use(const ObjectDetection& detection, double now_s);
  void use(const DetectorStatus& status, double now_s);

  const ReceivedMap& map() const { return map_; }
  /// In a part of the map; without a pose if it has not been there.
  const SmoothedCamera& depth_camera(std::int32_t part) const;
  /// What the camera saw last; nullptr: no view has come.
  const CameraView* view() const { return view_ ? &*view_ : nullptr; }
  RunHistory& history() { return history_; }
  const UpdateLog& updates() const { return updates_; }
  /// The known objects that are in the map, as the detector says.
  std::vector<DrawnObject> objects() const;
  bool is_empty() const { return map_.counts().slices == 0; }

  /// The segmenter has completed its map, and all of it has arrived.
  bool is_complete() const { return map_.final_update_seen() && map_.lag_slices() == 0; }
  /// A detector still looks for objects in the map: it has not said that it is finished, and was
  /// heard within kSilence_s.
  bool is_searched(double now_s) const { return searched_s_ && now_s - *searched_s_ < kSilence_s; }
  /// Nothing has changed for kSilence_s.
  bool is_silent(double now_s) const { return now_s - last_change_s_ >= kSilence_s; }

  /// There is something to draw.
  bool has_picture() const { return view_ || !is_empty(); }

  /// True when the map is `every_s` of map time further than in the last snapshot, or after its
  /// begin; and when the segmenter was heard since the last snapshot for the first time. The map is
  /// as far as its newest slice that has its segments (without a segmenter, its newest slice) and
  /// the newest view.
  bool snapshot_is_due(double every_s) const;
  void note_snapshot();

  /// The segments of the newest answer of the segmenter; empty when there are none.
  const Highlight& answered() const { return answered_; }
  bool answer_is_due() const { return is_answer_new_ && !is_empty(); }
  void note_answer() { is_answer_new_ = false; }

  /// The final pictures with this suffix in their names do not exist or are out of date.
  bool final_is_due(const std::string& suffix) const {
    return !is_empty() && final_suffix_ != suffix;
  }
  /// Call before the final pictures are drawn: they show the newest of everything, and no labels of
  /// earlier segmenters.
  void prepare_final() { map_.settle(); }
  void note_final(const std::string& suffix) { final_suffix_ = suffix; }

 private:
  static constexpr double kSilence_s = 5.0;

  /// Of a snapshot that was drawn.
  struct Snapshot {
    std::int64_t utime = 0;  ///< of the map in it
    bool has_segments = false;
  };

  void note_change(double now_s);
  void follow(const CameraPose& pose);
  void note_labelled(std::int32_t slice_id);
  std::int64_t utime_of_snapshot() const;

  ReceivedMap map_;
  std::map<std::int32_t, SmoothedCamera> depth_cameras_;  // by part of the map
  std::int64_t camera_utime_ = -1;                        // of the newest pose used; -1: none
  std::int32_t camera_part_ = 0;                          // of the same
  RunHistory history_;
  bool keep_updates_;
  UpdateLog updates_;
  double last_change_s_;
  std::optional<CameraView> view_;
  std::int64_t slice_utime_ = 0;      // of the newest slice
  std::int64_t labelled_utime_ = 0;   // of the newest slice with labels
  std::optional<Snapshot> snapshot_;  // the last one
  ObjectTable objects_;
  std::optional<double> searched_s_;  // when a detector was heard that is not finished
  Highlight answered_;
  std::int64_t answer_utime_ = 0;
  bool is_answer_new_ = false;
  std::optional<std::string> final_suffix_;  // of the final pictures that are up to date
};

}  // namespace kintsugi::viewer

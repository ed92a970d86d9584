#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "viewer/core/rendering/highlight.hpp"
#include "viewer/core/rendering/view.hpp"
#include "viewer/core/scene/scene.hpp"
#include "viewer/core/scene/update_log.hpp"
#include "viewer/process/run_history.hpp"

namespace kintsugi::viewer {

/// The scene of one map session, and what has been drawn of it. Times `now_s` are those of a
/// PatientClock.
class SessionScene {
 public:
  /// `keeps_updates`: for updates(), which takes memory for every segment that changes.
  SessionScene(std::int64_t map_session, double now_s, bool keeps_updates = false)
      : scene_(map_session), keeps_updates_(keeps_updates), last_news_s_(now_s) {}

  void use(CloudSlice slice, double now_s);
  void use(const SegmentUpdate& update, double now_s);
  void use(const CameraPose& pose);
  void use(const SegmenterStatus& status) { history_.add_slice_time(status); }
  /// Of several answers the newest counts, in whatever order they come.
  void use(const SegmentAnswer& answer);

  const Scene& scene() const { return scene_; }
  const FollowedCamera& followed() const { return followed_; }
  RunHistory& history() { return history_; }
  const UpdateLog& updates() const { return updates_; }
  std::int64_t memory_bytes() const { return scene_.memory_bytes() + updates_.memory_bytes(); }
  bool is_empty() const { return scene_.counts().slices == 0; }

  /// The segmenter has said that its map is complete, and all of it is here.
  bool is_complete() const { return scene_.final_update_seen() && scene_.lag_slices() == 0; }
  /// Nothing new has come for kPatience_s.
  bool is_silent(double now_s) const { return now_s - last_news_s_ >= kPatience_s; }

  /// A snapshot is due each time so many slices more are shown: those with their segments,
  /// corrected ones again; without a segmenter, all.
  bool snapshot_is_due(int every_slices) const;
  void note_snapshot() { in_snapshot_ = scene_.counts(); }

  /// The segments of the newest answer: none when it has none, or there was no answer.
  const Highlight& answered() const { return answered_; }
  bool answer_is_due() const { return is_answer_new_ && !is_empty(); }
  void note_answer() { is_answer_new_ = false; }

  bool frame_is_due(double period_s) const;
  void note_frame() { last_frame_utime_ = scene_.utime(); }

  /// Final pictures whose names end in `suffix` do not show the scene as it is yet.
  bool final_is_due(const std::string& suffix) const {
    return !is_empty() && final_suffix_ != suffix;
  }
  /// Before final pictures are drawn: labels of a segmenter that was replaced are not among them.
  void prepare_final() { scene_.discard_old_labels(); }
  void note_final(const std::string& suffix) { final_suffix_ = suffix; }

 private:
  static constexpr double kPatience_s = 5.0;

  void note_news(double now_s);

  Scene scene_;
  FollowedCamera followed_;
  RunHistory history_;
  bool keeps_updates_;
  UpdateLog updates_;
  double last_news_s_;
  SceneCounts in_snapshot_;  ///< of the last one
  Highlight answered_;
  std::int64_t answer_utime_ = 0;
  bool is_answer_new_ = false;
  std::optional<std::int64_t> last_frame_utime_;
  std::optional<std::string> final_suffix_;  ///< of the final pictures that show the scene as it is
};

}  // namespace kintsugi::viewer

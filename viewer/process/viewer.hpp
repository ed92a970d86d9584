#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "viewer/process/map_sessions.hpp"
#include "viewer/process/message.hpp"
#include "viewer/process/painter.hpp"
#include "viewer/process/picture_folder.hpp"
#include "viewer/process/retry_clock.hpp"
#include "viewer/process/video_recorder.hpp"

namespace kintsugi::viewer {

/// Keeps the scene of the newest session of one map and writes its pictures. One thread.
///
/// A session with a larger number is newer: its scene begins beside the one before, and is drawn
/// from its first slice on. The one before is kept for what still comes of it; its final pictures
/// are written under its session number when it is complete, or nothing new came for some seconds.
/// Of sessions earlier than those two nothing is wanted any more.
///
/// A file that cannot be written is reported, and the viewer goes on; final pictures are tried
/// again until they are written. Times `now_s` are those of a PatientClock.
class Viewer {
 public:
  struct Config {
    Painter::Config painter;
    std::filesystem::path folder = ".";  ///< of the pictures; must exist
    int every_slices = 10;               ///< a snapshot each time so many more slices are shown
    std::optional<std::filesystem::path> video;
    double video_period_s = 0.1;  ///< map time between two frames
    double video_frames_per_s = 20.0;

    /// Throws std::invalid_argument naming the field, its value and the bound.
    void validate() const;
  };
  struct Outputs {
    std::function<void(const cv::Mat3b& picture, const std::string& caption)> on_picture;
    /// Nothing more is wanted of this map session. May be empty.
    std::function<void(std::int64_t map_session)> on_forgotten;
  };

  /// Throws what Config::validate() and VideoFile throw.
  Viewer(const Config& config, Outputs outputs);

  void add(Message message, double now_s);

  /// Draws a snapshot, a frame of the video, and highlight.png after an answer of the segmenter, if
  /// they are due and time for drawing is left.
  void draw_if_due();
  void draw_snapshot_now();

  /// Writes the final pictures of every session that has ended: its final update is here and every
  /// slice that it counts; or nothing new came for some seconds, and nothing will come: nothing is
  /// known to be missing that may still be resent (`more_may_come`).
  void write_finals(double now_s, bool more_may_come);
  /// The newest session has ended and its final pictures are written, or were tried long enough.
  bool finished() const { return finished_; }

  /// Writes all final pictures that are due and closes the video. Call once, at the end.
  void close();

  /// All but what the receiver knows.
  ViewerStatus status() const;
  /// Pictures, final pictures of a session or videos that are not there and should be.
  std::int64_t failures() const { return failures_; }

 private:
  void use(CloudSlice slice, double now_s);
  void use(const SegmentUpdate& update, double now_s);
  void use(const CameraPose& pose, double now_s);
  void use(const SegmenterStatus& status, double now_s);
  void use(const SegmentAnswer& answer, double now_s);
  SessionScene* enter_session(std::int64_t session, double now_s);
  void forget_oldest();

  bool is_current(const SessionScene& shown) const { return &shown == sessions_.current_scene(); }
  std::string final_suffix(const SessionScene& shown) const;
  bool has_ended(const SessionScene& shown, double now_s, bool more_may_come) const;
  void note_finals(double now_s, bool all_written, bool has_current_ended);
  bool write_final(SessionScene& shown);

  void write_snapshot(SessionScene& shown, const cv::Mat3b& figure);
  void write_highlight(SessionScene& shown, const cv::Mat3b& figure);

  Config config_;
  Outputs outputs_;
  Painter painter_;
  PictureFolder folder_;
  std::unique_ptr<VideoRecorder> video_;

  std::string map_name_;
  MapSessions sessions_;

  bool finished_ = false;
  RetryClock finals_retry_;
  std::int64_t failures_ = 0;
};

}  // namespace kintsugi::viewer

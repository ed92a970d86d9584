#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "viewer/output/picture_folder.hpp"
#include "viewer/output/video_clock.hpp"
#include "viewer/output/video_recorder.hpp"
#include "viewer/process/painter.hpp"
#include "viewer/process/retry_clock.hpp"
#include "viewer/receiving/message.hpp"
#include "viewer/session/map_sessions.hpp"

namespace kintsugi::viewer {

/// Collects the messages of a map and writes its pictures. Not thread-safe.
///
/// The newest map session is drawn from its first slice on. The one before it is kept for messages
/// that arrive late; its final pictures, with its number in their names, are written when it is
/// complete or nothing new arrived for 5 s. Older sessions are forgotten.
///
/// A file that cannot be written is logged, and the viewer continues; final pictures are retried
/// until they are written. Times `now_s` are those of a PatientClock.
class ViewerProcess {
 public:
  struct Config {
    Painter::Config painter;
    std::filesystem::path folder = ".";          ///< for the pictures; must exist
    double every_s = 10.0;                       ///< map time between two snapshots
    std::optional<std::filesystem::path> video;  ///< .mp4 file; nothing: no video
    double video_rate_hz = 10.0;  ///< pictures in a second of map time and of the video

    /// @throws std::invalid_argument naming the field, its value and the bound
    void validate() const;
  };
  /// Called besides writing files; not empty.
  struct Outputs {
    std::function<void(const cv::Mat3b& picture, const std::string& caption)> on_picture =
        [](const cv::Mat3b&, const std::string&) {};
    /// No more messages of this map session are needed.
    std::function<void(std::int64_t map_session)> on_forgotten = [](std::int64_t) {};
  };

  /// @throws as Config::validate() and VideoFile
  ViewerProcess(const Config& config, Outputs outputs);

  void add(Message message, double now_s);

  /// Draws what is due, if drawing has not used its share of the time: a snapshot, a frame of the
  /// video, and highlight.png after an answer of the segmenter.
  void draw_if_due();
  void draw_snapshot_now();

  /// Writes the final pictures of each session that has ended. A session has ended when the final
  /// update and every slice have arrived; or when the final update has arrived or a newer session
  /// exists, nothing new arrived for 5 s, and nothing is expected; and no detector looks for
  /// objects in it. `more_may_come`: messages are missing that may still be resent.
  void write_finals(double now_s, bool more_may_come);
  /// Every session that is kept has ended, and its final pictures are written or cannot be.
  bool finished() const { return finished_; }

  /// Writes all final pictures that are due and closes the video. Call once, at the end.
  void close();

  /// The session that is drawn; nullptr: there is none.
  const MapSession* current() const { return sessions_.current(); }
  /// All fields but those of the receiver.
  ViewerStatus status() const;
  /// Number of snapshots, sets of final pictures and videos that could not be written.
  std::int64_t failures() const { return failures_; }

 private:
  MapSession* find_or_create_session(std::int64_t session, double now_s);
  void forget_oldest();

  bool is_current(const MapSession& session) const { return &session == sessions_.current(); }
  std::string final_suffix(const MapSession& session) const;
  bool has_ended(const MapSession& session, double now_s, bool more_may_come) const;
  void note_finals(double now_s, bool all_written, bool have_all_ended);
  bool write_final(MapSession& session);
  void replace_finals(const std::string& suffix, std::set<std::string> files);

  void write_snapshot(MapSession& session, const cv::Mat3b& figure);
  int frames_due() const;
  void add_to_video(const MapSession& session, const cv::Mat3b& figure, int frames);
  void end_video();
  void write_highlight(MapSession& session, const cv::Mat3b& figure);

  Config config_;
  Outputs outputs_;
  Painter painter_;
  PictureFolder folder_;
  std::unique_ptr<VideoRecorder> video_;
  VideoClock video_clock_;

  std::string map_name_;
  MapSessions sessions_;

  bool finished_ = false;
  RetryClock finals_retry_;
  std::map<std::string, std::set<std::string>> finals_;  // files that are written, by suffix
  std::int64_t failures_ = 0;
};

}  // namespace kintsugi::viewer

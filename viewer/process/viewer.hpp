#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "viewer/core/renderer.hpp"
#include "viewer/output/video_file.hpp"
#include "viewer/process/receiver.hpp"
#include "viewer/process/run_history.hpp"

namespace kintsugi::viewer {

/// Keeps the scene of the newest map session and writes its pictures. One thread.
///
/// A message of a map session not seen before starts a new scene; the old one's final pictures are
/// kept under its session number. Two mappers that run at the same time are told apart by
/// Config::map_name; camera poses carry no name, so then they start no scene. A file that cannot be
/// written is reported and counted, and the viewer goes on.
class Viewer {
 public:
  struct Config {
    Renderer::Config renderer;
    View view = FollowView{};
    std::filesystem::path folder = ".";  ///< of the pictures; must exist
    std::string map_name;                ///< draw only the map with this name; empty: any
    int every_slices = 10;               ///< a snapshot each time so many more slices are shown
    std::optional<std::filesystem::path> video;
    double video_period_s = 0.1;  ///< map time between two frames
    double video_frames_per_s = 20.0;
    bool plots = false;              ///< write plots.png with the final pictures
    double max_drawing_share = 1.0;  ///< of the wall time; less leaves the rest to other processes

    /// Throws std::invalid_argument naming the field, its value and the bound.
    void validate() const;
  };
  using OnSnapshot = std::function<void(const cv::Mat3b& picture, const std::string& caption)>;

  /// Throws what Config::validate() and VideoFile throw.
  Viewer(const Config& config, OnSnapshot on_snapshot);

  void add(Message message);

  /// Draws a snapshot and a frame of the video if they are due, and time for drawing is left.
  void draw_if_due();
  void draw_snapshot_now();

  /// The final update has been applied, and every slice it counts is here; or has not come for
  /// kPatience_s.
  bool complete() const;
  bool finished() const { return finished_; }

  /// Writes the final pictures of the scene, unless they show it already.
  void write_final();
  /// Writes the final pictures and closes the video. Call once, at the end.
  void close();

  /// All but what the receiver knows.
  ViewerStatus status() const;
  std::int64_t failures() const { return failures_; }  ///< files that could not be written

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double kPatience_s = 5.0;

  void use(CloudSlice slice);
  void use(const SegmentUpdate& update);
  void use(const CameraPose& pose);
  void use(const SegmenterStatus& status);
  bool is_wanted(const std::string& map_name) const;
  bool enter_session(std::int64_t session);
  void write_final_as(const std::string& suffix);

  std::int64_t shown_slices() const;
  bool snapshot_due() const;
  bool frame_due() const;
  cv::Mat3b draw(const View& view);
  void write_snapshot(const cv::Mat3b& figure);
  void add_frame(const cv::Mat3b& figure);
  void save(const std::string& name, const cv::Mat3b& image);
  template <class Action>
  bool attempt(Action&& action);

  Config config_;
  OnSnapshot on_snapshot_;
  Renderer renderer_;
  std::unique_ptr<VideoFile> video_;
  std::optional<std::int64_t> last_frame_utime_;

  std::optional<Scene> scene_;
  FollowedCamera followed_;
  RunHistory history_;
  std::set<std::int64_t> past_sessions_;
  std::int64_t shown_in_snapshot_ = 0;
  bool changed_since_final_ = false;
  bool finished_ = false;
  Clock::time_point last_map_message_ = Clock::now();

  Clock::time_point next_drawing_ = Clock::now();
  double render_ms_ = 0.0;
  std::int64_t snapshots_written_ = 0;
  std::int64_t failures_ = 0;
};

}  // namespace kintsugi::viewer

#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "viewer/core/rendering/renderer.hpp"
#include "viewer/process/session_scene.hpp"

namespace kintsugi::viewer {

struct NamedPicture {
  std::string name;
  cv::Mat3b picture;
};

/// Draws the pictures of map sessions, and notes the time that takes.
class Painter {
 public:
  struct Config {
    Renderer::Config renderer;
    View view = FollowView{};
    Highlight highlight;                   ///< in all pictures
    bool plots = false;                    ///< draw plots with the final pictures
    std::vector<std::uint32_t> timelines;  ///< segments of which timelines are drawn with them
    double max_drawing_share = 1.0;  ///< of the wall time; less leaves the rest to other processes

    /// Throws std::invalid_argument naming the field, its value and the bound.
    void validate() const;
  };

  /// Throws what Config::validate() throws.
  explicit Painter(const Config& config);

  /// What has been drawn has had its share of the time: the next picture is to wait.
  bool is_resting() const { return Clock::now() < rested_; }

  /// A picture of the run: with the poses that were heard, in the view that was chosen, and with
  /// the segments of the newest answer highlighted.
  cv::Mat3b draw_figure(SessionScene& shown);

  /// The figure for a person first, then what is written beside it. The same for everyone who has
  /// the map: without poses, times and answers, from
  /// above.
  std::vector<NamedPicture> draw_finals(SessionScene& shown);

  double render_ms() const { return render_ms_; }  ///< of the last figure

 private:
  using Clock = std::chrono::steady_clock;

  void note_time(SessionScene& shown, Clock::time_point start);

  Config config_;
  Renderer renderer_;
  Clock::time_point rested_ = Clock::now();
  double render_ms_ = 0.0;
};

}  // namespace kintsugi::viewer

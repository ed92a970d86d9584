#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "viewer/core/camera/viewpoint.hpp"
#include "viewer/core/figure/map_renderer.hpp"
#include "viewer/core/figure/run_figure.hpp"
#include "viewer/session/map_session.hpp"

namespace kintsugi::viewer {

struct NamedPicture {
  std::string name;  ///< of the file, without suffix and extension
  cv::Mat3b picture;
  std::string part = {};  ///< behind the suffix: empty, or ".partK" of a part of the map
};

/// Draws the pictures of map sessions, and limits the share of time that drawing takes.
class Painter {
 public:
  struct Config {
    MapRenderer::Config renderer;
    Viewpoint viewpoint = FollowViewpoint{};  ///< of pictures of the run; final: the overview
    Highlight highlight;                      ///< in all pictures
    bool plots = false;                       ///< draw plots.png with the final pictures
    std::vector<std::uint32_t> timelines;     ///< segments whose timelines are drawn with them
    double max_drawing_share = 1.0;           ///< of the wall time
    double map_period_s = 2.0;                ///< map time after which a picture has the map anew

    /// @throws std::invalid_argument naming the field, its value and the bound
    void validate() const;
  };

  /// @throws std::invalid_argument as Config::validate()
  explicit Painter(const Config& config);
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  /// Drawing has used its share of the time: wait with the next picture.
  bool is_resting() const { return Clock::now() < rest_end_; }

  /// Draws a picture of the run: with the poses received, from the configured viewpoint, and with
  /// the segments of the newest answer highlighted. Map::kMayBeOld: the map may be map_period_s
  /// old, and older while drawing has used its share of the time.
  cv::Mat3b draw_figure(MapSession& session, RunFigure::Map map);

  /// Draws the final pictures, the figure first: of the part of the map in which the camera was
  /// last, then of the other parts that have points. They do not depend on poses, times and
  /// answers, so that they are the same in every viewer that has the map; plots do, and one shows
  /// the objects that were found, if there are any.
  std::vector<NamedPicture> draw_finals(MapSession& session);

  double render_ms() const { return render_ms_; }  ///< wall time of the last figure with its map

 private:
  using Clock = std::chrono::steady_clock;

  std::vector<NamedPicture> draw_final(MapSession& session, std::int32_t part,
                                       const std::string& part_of_name);
  bool map_is_due(const MapSession& session) const;
  Clock::time_point after_rest(double drawing_ms) const;
  void note_time(MapSession& session, double render_ms);

  Config config_;
  MapRenderer renderer_;
  RunFigure run_figure_{renderer_};
  Clock::time_point rest_end_ = Clock::now();
  Clock::time_point map_rest_end_ = Clock::now();
  std::int64_t map_utime_ = 0;  // of the map in the last picture of a run
  double without_map_ms_ = 0.0;
  double render_ms_ = 0.0;
};

}  // namespace kintsugi::viewer

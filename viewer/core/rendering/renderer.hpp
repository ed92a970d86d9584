#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "viewer/core/rendering/highlight.hpp"
#include "viewer/core/rendering/panel.hpp"
#include "viewer/core/rendering/shade.hpp"
#include "viewer/core/rendering/splat.hpp"
#include "viewer/core/rendering/view.hpp"
#include "viewer/core/scene/camera_track.hpp"
#include "viewer/core/scene/scene.hpp"

namespace kintsugi::viewer {

/// What a picture shows, and from where. Refers to the scene and the followed camera.
struct Subject {
  const Scene& scene;
  CameraTrack track;
  const FollowedCamera& followed;
  View view;
  Highlight highlight = {};
};

/// Draws a Scene. Pure functions of the subject and the configuration: the same picture,
/// byte for byte, on any number of threads.
class Renderer {
 public:
  struct Config {
    int width_px = 1280;      ///< of a picture
    int height_px = 720;      ///< of a picture
    int supersampling = 2;    ///< each pixel is the mean of this many squared
    double frustum_m = 0.35;  ///< depth of the pyramid that stands for the camera
    bool label_ids = false;   ///< write the ids of the largest segments that are seen
    SplatConfig splat;
    ViewConfig view;

    /// Throws std::invalid_argument naming the field, its value and the bound.
    void validate() const;
  };

  explicit Renderer(const Config& config);

  /// The paper's Fig. 1 in one picture: the map in true colour and its segments side by side, the
  /// newest slice below each on its own, the camera's path, and a caption. Highlighted segments
  /// have their ids, are outlined and take the place of the newest slice; all else is dimmed.
  cv::Mat3b draw_figure(const Subject& subject, const std::string& caption) const;

  /// The map alone in one coloring, filling the picture.
  cv::Mat3b draw_map(const Subject& subject, Coloring coloring) const;

  const Config& config() const { return config_; }

 private:
  Panel panel(const Subject& subject, std::vector<PointChunk> chunks,
              const VirtualCamera& camera) const;
  /// `track` may be nullptr: not drawn.
  cv::Mat3b draw_panel(const Panel& panel, Coloring coloring, const std::string& title,
                       const CameraTrack* track) const;

  Config config_;
};

/// What the caption of a picture of the run says: time, points, segments, slices, lag.
std::string caption(const Scene& scene);

/// That of a final picture: the same without the time, which depends on the poses that were heard.
std::string final_caption(const Scene& scene);

}  // namespace kintsugi::viewer

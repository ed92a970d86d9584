#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "viewer/core/camera/viewpoint.hpp"
#include "viewer/core/figure/panel.hpp"
#include "viewer/core/map/camera_track.hpp"
#include "viewer/core/map/received_map.hpp"
#include "viewer/core/rendering/highlight.hpp"
#include "viewer/core/rendering/shade.hpp"
#include "viewer/core/rendering/splat.hpp"

namespace kintsugi::viewer {

/// What a picture shows, and from where. Refers to the map and the camera.
struct Subject {
  const ReceivedMap& map;
  CameraTrack track;
  const SmoothedCamera& depth_camera;
  Viewpoint viewpoint;
  Highlight highlight = {};
};

/// Draws a ReceivedMap. The pictures depend on the subject and the configuration alone: the same
/// bytes with any number of threads.
class MapRenderer {
 public:
  struct Config {
    int width_px = 1280;      ///< of a picture
    int height_px = 720;      ///< of a picture
    int supersampling = 2;    ///< each pixel is the mean of this number squared of samples
    double frustum_m = 0.35;  ///< depth of the pyramid drawn for the depth camera
    bool label_ids = false;   ///< write the ids of the largest visible segments
    SplatConfig splat;
    ViewpointConfig viewpoint;

    /// @throws std::invalid_argument naming the field, its value and the bound
    void validate() const;
  };

  /// @throws std::invalid_argument as Config::validate()
  explicit MapRenderer(const Config& config);

  /// A figure like Fig. 1 of the paper: left in true colour, right in the colours of the segments;
  /// above the map with the camera's path, below the newest slice alone; a caption. When segments
  /// are highlighted, a close-up of them replaces the newest slice.
  cv::Mat3b draw_figure(const Subject& subject, const std::string& caption) const;

  /// The map alone in one coloring, filling the picture.
  cv::Mat3b draw_map(const Subject& subject, Coloring coloring) const;

 private:
  Panel panel(const Subject& subject, std::vector<PointChunk> chunks,
              const VirtualCamera& camera) const;
  /// `track` may be nullptr: none is drawn.
  cv::Mat3b draw_panel(const Panel& panel, Coloring coloring, const std::string& title,
                       const CameraTrack* track) const;

  Config config_;
};

/// Caption of a picture of the run: map time, points, segments, slices, lag.
std::string caption(const ReceivedMap& map);

/// Caption of a final picture: without the time, which depends on the poses received.
std::string final_caption(const ReceivedMap& map);

}  // namespace kintsugi::viewer

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "viewer/core/camera/frustum.hpp"
#include "viewer/core/camera/viewpoint.hpp"
#include "viewer/core/figure/object_boxes.hpp"
#include "viewer/core/figure/panel.hpp"
#include "viewer/core/figure/segment_labels.hpp"
#include "viewer/core/map/camera_track.hpp"
#include "viewer/core/map/received_map.hpp"
#include "viewer/core/rendering/highlight.hpp"
#include "viewer/core/rendering/shade.hpp"
#include "viewer/core/rendering/splat.hpp"

namespace kintsugi::viewer {

/// What a picture shows, and from where. Refers to the map and the camera.
struct Subject {
  const ReceivedMap& map;
  std::int32_t part;  ///< of the map; nothing else of it is shown
  CameraTrack track;
  const SmoothedCamera& depth_camera;
  Viewpoint viewpoint;
  Highlight highlight = {};
  std::vector<DrawnObject> objects = {};
};

/// A picture of points, on which nothing is written yet.
struct MapPicture {
  std::string title;
  VirtualCamera camera;
  cv::Mat3b image;
  std::vector<SegmentLabel> labels;
  bool has_camera = true;  ///< the camera's path and frustum are drawn over it
};

/// The figure like Fig. 1 of the paper, and the pictures that figures are made of. They depend on
/// the subject and the configuration alone: the same bytes with any number of threads.
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

  const Config& config() const { return config_; }

  /// The whole part of the map with the camera's path, left in true colour, right in the colours of
  /// the segments; a caption. When segments are highlighted, a close-up of them is below.
  cv::Mat3b draw_figure(const Subject& subject, const std::string& caption) const;

  /// The map alone in one coloring, filling the picture.
  cv::Mat3b draw_map(const Subject& subject, Coloring coloring) const;

  /// The map in each of the colorings, seen from the subject's viewpoint.
  std::vector<MapPicture> map_pictures(const Subject& subject, cv::Size size,
                                       const std::vector<Coloring>& colorings) const;
  /// A close-up of the highlighted segments, seen in the direction of `R_WV`. Empty when there are
  /// none in the map.
  std::vector<MapPicture> close_ups(const Subject& subject, const Eigen::Matrix3d& R_WV,
                                    cv::Size size, const std::vector<Coloring>& colorings) const;

  /// Draws the subject's camera and objects over the picture, and writes ids and title.
  cv::Mat3b finish(const MapPicture& picture, const Subject& subject) const;

  /// What is drawn for the camera; nothing: its pose is not known.
  std::optional<Frustum> frustum(const CameraTrack& track) const;

 private:
  std::vector<MapPicture> pictures(const Subject& subject, const VirtualCamera& camera,
                                   const std::vector<Coloring>& colorings) const;

  Config config_;
};

/// Caption of a picture of the run: map time, points, segments, slices, lag. Of a map of several
/// parts the points are those of `part`, all else is of the whole map.
std::string caption(const ReceivedMap& map, std::int32_t part);

/// Caption of a final picture: without the time, which depends on the poses received.
std::string final_caption(const ReceivedMap& map, std::int32_t part);

}  // namespace kintsugi::viewer

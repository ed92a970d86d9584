#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "lcmtypes/messages.hpp"
#include "viewer/core/figure/map_renderer.hpp"

namespace kintsugi::viewer {

/// Pictures of a run: the camera's image with the segments in it beside the growing map, in the
/// colours of the segments and in true colour (or a close-up of highlighted segments); the caption.
/// Without a view of the camera it is MapRenderer's figure.
///
/// The camera's image costs little and the map much, so the map is drawn anew less often: the
/// camera's path and frustum, which are drawn over it, always show the present.
class RunFigure {
 public:
  explicit RunFigure(const MapRenderer& renderer) : renderer_(renderer) {}

  enum class Map {
    kNew,       ///< drawn anew
    kMayBeOld,  ///< that of an earlier call, where that shows the same subject from a viewpoint
                ///< from which the whole frustum is in the picture
  };

  /// `view`: the newest; nullptr: none has come.
  cv::Mat3b draw(const Subject& subject, const CameraView* view, const std::string& caption,
                 Map map);

  /// The last call of draw() has drawn the map anew.
  bool has_drawn_map() const { return has_drawn_map_; }

 private:
  /// Of the map pictures that are kept.
  struct Origin {
    std::int64_t map_session = 0;
    std::int32_t part = 0;
    Highlight highlight;
    cv::Size size;
    bool operator==(const Origin&) const = default;
  };

  bool may_be_used(const Origin& origin, const Subject& subject) const;
  void draw_maps(const Subject& subject, cv::Size size);

  const MapRenderer& renderer_;
  Origin origin_;
  std::vector<MapPicture> maps_;  // the upper one and the lower one
  bool has_drawn_map_ = false;
};

}  // namespace kintsugi::viewer

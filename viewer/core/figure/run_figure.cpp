#include "viewer/core/figure/run_figure.hpp"

#include <algorithm>
#include <array>

#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/figure/camera_panel.hpp"
#include "viewer/core/figure/overlay.hpp"

namespace kintsugi::viewer {
namespace {

constexpr char kLegend[] = "tinted: its segment   own colours: not segmented yet";

/// The parts of the picture: the camera's image with the texts below it, the two maps to the right
/// of it, one above the other.
struct Layout {
  cv::Rect camera;
  cv::Rect caption;
  cv::Rect legend;
  std::array<cv::Rect, 2> maps;
};

Layout layout_of(int width, int height, const CameraView& view) {
  constexpr int kGap = 2;
  const int text_height = std::clamp(height / 20, 16, 60);
  const cv::Size box(width * 2 / 3,
                     height - 2 * text_height);  // the camera's image has the larger part
  const cv::Size camera = camera_panel_size(view, box);
  const int left = std::max(camera.width, width / 2);
  const int text_top = std::max(camera.height, height / 2);
  const int right = width - left - kGap;
  const int map_height = (height - kGap) / 2;
  Layout layout;
  layout.camera = {cv::Point((left - camera.width) / 2, 0), camera};
  layout.caption = {0, text_top, left, text_height};
  layout.legend = {0, text_top + text_height, left, text_height};
  layout.maps[0] = {width - right, 0, right, map_height};
  layout.maps[1] = {width - right, height - map_height, right, map_height};
  return layout;
}

}  // namespace

cv::Mat3b RunFigure::draw(const Subject& subject, const CameraView* view,
                          const std::string& caption, Map map) {
  if (view == nullptr) {
    has_drawn_map_ = true;
    return renderer_.draw_figure(subject, caption);
  }
  const MapRenderer::Config& config = renderer_.config();
  const Layout layout = layout_of(config.width_px, config.height_px, *view);
  const Origin origin{subject.map.map_session(), subject.part, subject.highlight,
                      layout.maps[0].size()};
  has_drawn_map_ = map == Map::kNew || !may_be_used(origin, subject);
  if (has_drawn_map_) {
    draw_maps(subject, origin.size);
    origin_ = origin;
  }

  cv::Mat3b figure(config.height_px, config.width_px, palette::kPanelGap);
  figure.colRange(0, layout.legend.br().x).setTo(cv::Scalar(palette::kCaptionBar));
  draw_camera_panel(subject.map.chunks(subject.part), *view, layout.camera.size(),
                    subject.highlight, subject.objects, {config.label_ids, config.splat})
      .copyTo(figure(layout.camera));
  draw_caption(figure, layout.caption, caption);
  draw_caption(figure, layout.legend, kLegend);
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    renderer_.finish(maps_[i], subject).copyTo(figure(layout.maps[i]));
  }
  return figure;
}

bool RunFigure::may_be_used(const Origin& origin, const Subject& subject) const {
  if (maps_.empty() || origin != origin_) return false;
  const auto frustum = renderer_.frustum(subject.track);
  return !frustum || std::holds_alternative<FixedViewpoint>(subject.viewpoint) ||
         is_in_picture(*frustum, maps_.front().camera);
}

void RunFigure::draw_maps(const Subject& subject, cv::Size size) {
  maps_ = renderer_.map_pictures(subject, size, {Coloring::kSegments, Coloring::kTrue});
  std::vector<MapPicture> close_up =
      renderer_.close_ups(subject, maps_.front().camera.X_WV.linear(), size, {Coloring::kSegments});
  if (!close_up.empty()) maps_[1] = std::move(close_up.front());
}

}  // namespace kintsugi::viewer

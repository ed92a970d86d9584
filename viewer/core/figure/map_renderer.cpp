#include "viewer/core/figure/map_renderer.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/text_format.hpp"
#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/drawing/text.hpp"
#include "viewer/core/figure/overlay.hpp"
#include "viewer/core/figure/segment_labels.hpp"

namespace kintsugi::viewer {
namespace {

VirtualCamera camera_of(const Subject& subject, cv::Size size, const ViewpointConfig& config) {
  return camera_at(subject.viewpoint, subject.map, subject.depth_camera, size.width, size.height,
                   config);
}

/// The parts of the figure: two columns, each with the map above and the detail below; the caption
/// at the bottom.
struct Layout {
  std::array<cv::Rect, 2> map;
  std::array<cv::Rect, 2> detail;
  cv::Rect caption;
};

Layout layout_of(int width, int height) {
  constexpr int kGap = 2;
  const int caption_height = std::clamp(height / 20, 16, 60);
  const int map_height = (height - caption_height) * 68 / 100;
  const int detail_top = map_height + kGap;
  const int detail_height = height - caption_height - detail_top;
  const int column = (width - kGap) / 2;
  Layout layout;
  for (int i = 0; i < 2; ++i) {
    const int left = i == 0 ? 0 : width - column;
    layout.map[i] = {left, 0, column, map_height};
    layout.detail[i] = {left, detail_top, column, detail_height};
  }
  layout.caption = {0, height - caption_height, width, caption_height};
  return layout;
}

/// What is below the map: a close-up of the highlighted segments, or the newest slice alone.
struct Detail {
  std::string title;
  std::vector<PointChunk> chunks;
  VirtualCamera camera;
};

Detail detail_of(const Subject& subject, const Eigen::Matrix3d& R_WV, cv::Size size,
                 const ViewpointConfig& config) {
  const Intrinsics intrinsics = pinhole(size.width, size.height, config.field_of_view_rad);
  std::vector<PointChunk> all = subject.map.chunks();
  if (const auto camera = close_up(all, subject.highlight, R_WV, intrinsics)) {
    return {"highlighted", std::move(all), *camera};
  }
  const MapSlice* const newest = subject.map.newest_slice();
  if (newest == nullptr) return {"no slice yet", {}, camera_around({}, R_WV, intrinsics, config)};
  std::vector<PointChunk> chunks;
  newest->append_chunks(chunks);
  const VirtualCamera camera = camera_around(chunks, R_WV, intrinsics, config);
  return {"newest slice: " + std::to_string(newest->id()), std::move(chunks), camera};
}

}  // namespace

void MapRenderer::Config::validate() const {
  check_range("MapRenderer::Config::width_px", width_px, 160, 16384);
  check_range("MapRenderer::Config::height_px", height_px, 120, 16384);
  check_range("MapRenderer::Config::supersampling", supersampling, 1, 4);
  require(frustum_m > 0.0, "MapRenderer::Config::frustum_m", frustum_m, "> 0");
  splat.validate();
  viewpoint.validate();
}

MapRenderer::MapRenderer(const Config& config) : config_(config) { config_.validate(); }

cv::Mat3b MapRenderer::draw_figure(const Subject& subject, const std::string& caption) const {
  constexpr std::array kColorings{Coloring::kTrue, Coloring::kSegments};
  constexpr std::array kMapTitles{"map", "segments"};
  const Layout layout = layout_of(config_.width_px, config_.height_px);
  cv::Mat3b figure(config_.height_px, config_.width_px, palette::kPanelGap);
  const Panel map = panel(subject, subject.map.chunks(),
                          camera_of(subject, layout.map[0].size(), config_.viewpoint));
  const Detail detail =
      detail_of(subject, map.camera().X_WV.linear(), layout.detail[0].size(), config_.viewpoint);
  const Panel detail_panel = panel(subject, detail.chunks, detail.camera);
  for (std::size_t i = 0; i < kColorings.size(); ++i) {
    draw_panel(map, kColorings[i], kMapTitles[i], &subject.track).copyTo(figure(layout.map[i]));
    draw_panel(detail_panel, kColorings[i], detail.title, nullptr).copyTo(figure(layout.detail[i]));
  }
  draw_caption(figure, layout.caption, caption);
  return figure;
}

cv::Mat3b MapRenderer::draw_map(const Subject& subject, Coloring coloring) const {
  const VirtualCamera camera =
      camera_of(subject, {config_.width_px, config_.height_px}, config_.viewpoint);
  return draw_panel(panel(subject, subject.map.chunks(), camera), coloring, "", &subject.track);
}

Panel MapRenderer::panel(const Subject& subject, std::vector<PointChunk> chunks,
                         const VirtualCamera& camera) const {
  return {std::move(chunks), camera, config_.splat, config_.supersampling, subject.highlight};
}

cv::Mat3b MapRenderer::draw_panel(const Panel& panel, Coloring coloring, const std::string& title,
                                  const CameraTrack* track) const {
  cv::Mat3b image = panel.draw(coloring);
  if (track != nullptr) {
    draw_path(image, panel.camera(), track->path_W);
    if (track->X_WC) draw_frustum(image, panel.camera(), *track->X_WC, config_.frustum_m);
  }
  if (coloring == Coloring::kSegments && (config_.label_ids || !panel.highlight().empty())) {
    const std::array reserved{title_box(image, title)};
    draw_labels(image, place_labels(panel.segment_ids(), panel.highlight(), reserved));
  }
  draw_title(image, title);
  return image;
}

std::string caption(const ReceivedMap& map) {
  const double time_s = 1e-6 * static_cast<double>(map.utime() - map.first_utime());
  return format("%.1f s   ", time_s) + final_caption(map);
}

std::string final_caption(const ReceivedMap& map) {
  const MapCounts& counts = map.counts();
  return with_thousands(counts.points) + " points   " + with_thousands(counts.segments) +
         " segments   " + with_thousands(counts.slices) + " slices   lag " +
         std::to_string(map.lag_slices());
}

}  // namespace kintsugi::viewer

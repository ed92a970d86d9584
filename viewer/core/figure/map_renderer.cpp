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

const std::vector<Coloring> kBoth{Coloring::kTrue, Coloring::kSegments};

/// The parts of the figure: two columns, each with the map above and, if there is one, a close-up
/// below; the caption at the bottom.
struct Layout {
  std::array<cv::Rect, 2> map;
  std::array<cv::Rect, 2> close_up;
  cv::Rect caption;
};

Layout layout_of(int width, int height, bool has_close_up) {
  constexpr int kGap = 2;
  const int caption_height = std::clamp(height / 20, 16, 60);
  const int map_height = (height - caption_height) * (has_close_up ? 68 : 100) / 100;
  const int close_up_top = map_height + kGap;
  const int column = (width - kGap) / 2;
  Layout layout;
  for (std::size_t i = 0; i < layout.map.size(); ++i) {
    const int left = i == 0 ? 0 : width - column;
    layout.map[i] = {left, 0, column, map_height};
    layout.close_up[i] = {left, close_up_top, column,
                          std::max(0, height - caption_height - close_up_top)};
  }
  layout.caption = {0, height - caption_height, width, caption_height};
  return layout;
}

bool has_highlighted(const Subject& subject) {
  const std::vector<PointChunk> chunks = subject.map.chunks(subject.part);
  return !subject.highlight.empty() && std::ranges::any_of(chunks, [&](const PointChunk& chunk) {
    return std::ranges::any_of(chunk.labels,
                               [&](std::uint32_t id) { return subject.highlight.contains(id); });
  });
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
  const bool has_close_up = has_highlighted(subject);
  const Layout layout = layout_of(config_.width_px, config_.height_px, has_close_up);
  cv::Mat3b figure(config_.height_px, config_.width_px, palette::kPanelGap);
  const std::vector<MapPicture> maps = map_pictures(subject, layout.map[0].size(), kBoth);
  for (std::size_t i = 0; i < maps.size(); ++i) {
    finish(maps[i], subject).copyTo(figure(layout.map[i]));
  }
  if (has_close_up) {
    const std::vector<MapPicture> details =
        close_ups(subject, maps.front().camera.X_WV.linear(), layout.close_up[0].size(), kBoth);
    for (std::size_t i = 0; i < details.size(); ++i) {
      finish(details[i], subject).copyTo(figure(layout.close_up[i]));
    }
  }
  draw_caption(figure, layout.caption, caption);
  return figure;
}

cv::Mat3b MapRenderer::draw_map(const Subject& subject, Coloring coloring) const {
  std::vector<MapPicture> maps =
      map_pictures(subject, {config_.width_px, config_.height_px}, {coloring});
  maps.front().title.clear();
  return finish(maps.front(), subject);
}

std::optional<Frustum> MapRenderer::frustum(const CameraTrack& track) const {
  if (!track.X_WC) return std::nullopt;
  return frustum_of(*track.X_WC, config_.frustum_m);
}

std::vector<MapPicture> MapRenderer::map_pictures(const Subject& subject, cv::Size size,
                                                  const std::vector<Coloring>& colorings) const {
  const std::optional<Frustum> camera_in_map = frustum(subject.track);
  std::vector<Eigen::Vector3d> all_of_these_W;
  if (camera_in_map) {
    const auto corners_W = camera_in_map->corners_W();
    all_of_these_W.assign(corners_W.begin(), corners_W.end());
  }
  const VirtualCamera camera =
      camera_at(subject.viewpoint, subject.map, subject.part, subject.depth_camera, size.width,
                size.height, config_.viewpoint, all_of_these_W);
  return pictures(subject, camera, colorings);
}

std::vector<MapPicture> MapRenderer::close_ups(const Subject& subject, const Eigen::Matrix3d& R_WV,
                                               cv::Size size,
                                               const std::vector<Coloring>& colorings) const {
  const Intrinsics intrinsics =
      pinhole(size.width, size.height, config_.viewpoint.field_of_view_rad);
  const auto camera =
      close_up(subject.map.chunks(subject.part), subject.highlight, R_WV, intrinsics);
  if (!camera) return {};
  std::vector<MapPicture> drawn = pictures(subject, *camera, colorings);
  for (MapPicture& picture : drawn) {
    picture.title = "highlighted";
    picture.has_camera = false;
  }
  return drawn;
}

std::vector<MapPicture> MapRenderer::pictures(const Subject& subject, const VirtualCamera& camera,
                                              const std::vector<Coloring>& colorings) const {
  const Panel panel(subject.map.chunks(subject.part), camera, config_.splat, config_.supersampling,
                    subject.highlight);
  std::vector<MapPicture> drawn;
  for (const Coloring coloring : colorings) {
    MapPicture& picture = drawn.emplace_back();
    picture.title = coloring == Coloring::kTrue ? "map" : "segments";
    picture.camera = camera;
    picture.image = panel.draw(coloring);
    if (coloring == Coloring::kSegments && (config_.label_ids || !subject.highlight.empty())) {
      const std::array reserved{title_box(picture.image, picture.title)};
      picture.labels = place_labels(panel.segment_ids(), subject.highlight, reserved);
    }
  }
  return drawn;
}

cv::Mat3b MapRenderer::finish(const MapPicture& picture, const Subject& subject) const {
  const CameraTrack& track = subject.track;
  cv::Mat3b image = picture.image.clone();
  if (picture.has_camera) {
    draw_path(image, picture.camera, track.path_W);
    draw_loops(image, picture.camera, track.loops);
    if (const auto camera_in_map = frustum(track)) {
      draw_frustum(image, picture.camera, *camera_in_map);
    }
  }
  draw_labels(image, picture.labels);
  std::vector<cv::Rect> reserved{title_box(image, picture.title)};
  for (const SegmentLabel& label : picture.labels) reserved.push_back(label.box);
  draw_objects(image, picture.camera, subject.objects, reserved);
  draw_title(image, picture.title);
  return image;
}

std::string caption(const ReceivedMap& map, std::int32_t part) {
  const double time_s = 1e-6 * static_cast<double>(map.utime() - map.first_utime());
  std::string text = format("%.1f s   ", time_s) + final_caption(map, part);
  const PointCounts points = map.points(part);
  if (points.in_volume > 0) {
    text += format("   %.0f %% may change", 100.0 * static_cast<double>(points.in_volume) /
                                                static_cast<double>(points.shown));
  }
  return text;
}

std::string final_caption(const ReceivedMap& map, std::int32_t part) {
  const MapCounts& counts = map.counts();
  const std::size_t num_parts = map.parts().size();
  std::string text = with_thousands(map.points(part).shown) + " points   ";
  if (num_parts > 1) {
    text = "part " + std::to_string(part) + ": " + text + "all " + std::to_string(num_parts) +
           " parts: ";
  }
  return text + with_thousands(counts.segments) + " segments   " + with_thousands(counts.slices) +
         " slices   lag " + std::to_string(map.lag_slices());
}

}  // namespace kintsugi::viewer

#include "viewer/core/renderer.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "viewer/core/overlay.hpp"
#include "viewer/core/require.hpp"
#include "viewer/core/text.hpp"

namespace kintsugi::viewer {
namespace {

/// The same view with `factor` times as many pixels along each side.
VirtualCamera supersampled(VirtualCamera camera, int factor) {
  Intrinsics& k = camera.intrinsics;
  k.fx *= factor;
  k.fy *= factor;
  k.cx = factor * k.cx + 0.5 * (factor - 1);
  k.cy = factor * k.cy + 0.5 * (factor - 1);
  k.width *= factor;
  k.height *= factor;
  return camera;
}

VirtualCamera camera_of(const Subject& subject, cv::Size size, const ViewConfig& config) {
  return camera_for(subject.view, subject.scene, subject.followed, size.width, size.height, config);
}

/// One picture of the points per coloring; what is seen in each pixel is found once.
std::vector<cv::Mat3b> draw_points(std::span<const PointChunk> chunks, const VirtualCamera& camera,
                                   std::span<const Coloring> colorings,
                                   const Renderer::Config& config) {
  const VirtualCamera fine = supersampled(camera, config.supersampling);
  const VisibilityImage visible = splat_points(chunks, fine, config.splat);
  const cv::Size size(camera.intrinsics.width, camera.intrinsics.height);
  std::vector<cv::Mat3b> images;
  for (const Coloring coloring : colorings) {
    images.emplace_back();
    cv::resize(shade(visible, chunks, fine, coloring), images.back(), size, 0.0, 0.0,
               cv::INTER_AREA);
  }
  return images;
}

void draw_camera(cv::Mat3b& image, const VirtualCamera& camera, const CameraTrack& track,
                 double frustum_m) {
  draw_path(image, camera, track.path_W);
  if (track.X_WC) draw_frustum(image, camera, *track.X_WC, frustum_m);
}

/// Where the parts of the figure go: two columns, map above slice, the caption below both.
struct Layout {
  std::array<cv::Rect, 2> map;
  std::array<cv::Rect, 2> slice;
  cv::Rect caption;
};

Layout layout_of(int width, int height) {
  constexpr int kGap = 2;
  const int caption_height = std::clamp(height / 20, 16, 60);
  const int map_height = (height - caption_height) * 68 / 100;
  const int slice_top = map_height + kGap;
  const int slice_height = height - caption_height - slice_top;
  const int column = (width - kGap) / 2;
  Layout layout;
  for (int i = 0; i < 2; ++i) {
    const int left = i == 0 ? 0 : width - column;
    layout.map[i] = {left, 0, column, map_height};
    layout.slice[i] = {left, slice_top, column, slice_height};
  }
  layout.caption = {0, height - caption_height, width, caption_height};
  return layout;
}

}  // namespace

void Renderer::Config::validate() const {
  require(width_px >= 160 && width_px <= 16384, "Renderer::Config::width_px", width_px,
          "in [160, 16384]");
  require(height_px >= 120 && height_px <= 16384, "Renderer::Config::height_px", height_px,
          "in [120, 16384]");
  require(supersampling >= 1 && supersampling <= 4, "Renderer::Config::supersampling",
          supersampling, "in [1, 4]");
  require(frustum_m > 0.0, "Renderer::Config::frustum_m", frustum_m, "> 0");
  splat.validate();
  view.validate();
}

Renderer::Renderer(const Config& config) : config_(config) { config_.validate(); }

cv::Mat3b Renderer::draw_figure(const Subject& subject, const std::string& caption) const {
  constexpr std::array kColorings{Coloring::kTrue, Coloring::kSegments};
  constexpr std::array kMapTitles{"map", "segments"};
  const Layout layout = layout_of(config_.width_px, config_.height_px);
  cv::Mat3b figure(config_.height_px, config_.width_px, cv::Vec3b(90, 80, 72));

  const Scene& scene = subject.scene;
  const VirtualCamera map_camera = camera_of(subject, layout.map[0].size(), config_.view);
  std::vector<cv::Mat3b> maps = draw_points(scene.chunks(), map_camera, kColorings, config_);

  const SceneSlice* newest = scene.newest_slice();
  const std::vector<PointChunk> slice_chunks =
      newest == nullptr ? std::vector<PointChunk>() : scene.chunks(*newest);
  const VirtualCamera slice_camera = camera_around(
      slice_chunks, map_camera.X_WV.linear(),
      pinhole(layout.slice[0].width, layout.slice[0].height, config_.view.field_of_view_rad),
      config_.view);
  std::vector<cv::Mat3b> slices = draw_points(slice_chunks, slice_camera, kColorings, config_);
  const std::string slice_title =
      newest == nullptr ? "no slice yet" : "newest slice: " + std::to_string(newest->id);

  for (std::size_t i = 0; i < kColorings.size(); ++i) {
    draw_camera(maps[i], map_camera, subject.track, config_.frustum_m);
    draw_title(maps[i], kMapTitles[i]);
    draw_title(slices[i], slice_title);
    maps[i].copyTo(figure(layout.map[i]));
    slices[i].copyTo(figure(layout.slice[i]));
  }
  draw_caption(figure, layout.caption, caption);
  return figure;
}

cv::Mat3b Renderer::draw_map(const Subject& subject, Coloring coloring) const {
  const VirtualCamera camera =
      camera_of(subject, {config_.width_px, config_.height_px}, config_.view);
  cv::Mat3b image =
      draw_points(subject.scene.chunks(), camera, std::array{coloring}, config_).front();
  draw_camera(image, camera, subject.track, config_.frustum_m);
  return image;
}

std::string caption(const Scene& scene) {
  const double time_s = 1e-6 * static_cast<double>(scene.utime() - scene.first_utime());
  std::array<char, 32> time{};
  std::snprintf(time.data(), time.size(), "%.1f s", time_s);
  return std::string(time.data()) + "   " + final_caption(scene);
}

std::string final_caption(const Scene& scene) {
  const SceneCounts& counts = scene.counts();
  return with_thousands(counts.points) + " points   " + with_thousands(counts.segments) +
         " segments   " + with_thousands(counts.slices) + " slices   lag " +
         std::to_string(scene.lag_slices());
}

}  // namespace kintsugi::viewer

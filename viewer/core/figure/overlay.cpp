#include "viewer/core/figure/overlay.hpp"

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/drawing/text.hpp"
#include "viewer/core/figure/line.hpp"

namespace kintsugi::viewer {
namespace {

double title_scale(const cv::Mat3b& image) { return std::clamp(image.cols / 1100.0, 0.4, 1.2); }

}  // namespace

void draw_path(cv::Mat3b& image, const VirtualCamera& camera,
               std::span<const Eigen::Vector3f> path_W) {
  const Pose X_VW = camera.X_WV.inverse();
  for (std::size_t i = 1; i < path_W.size(); ++i) {
    draw_line(image, camera, X_VW * path_W[i - 1].cast<double>(), X_VW * path_W[i].cast<double>(),
              palette::kCameraPath, line_width(image));
  }
}

void draw_loops(cv::Mat3b& image, const VirtualCamera& camera, std::span<const LoopLink> loops) {
  const Pose X_VW = camera.X_WV.inverse();
  const int width = line_width(image);
  const auto point_V = [&](const float* p_W) {
    return Eigen::Vector3d(X_VW * Eigen::Map<const Eigen::Vector3f>(p_W).cast<double>());
  };
  for (const LoopLink& loop : loops) {
    const Eigen::Vector3d later_V = point_V(loop.later_W);
    const Eigen::Vector3d earlier_V = point_V(loop.earlier_W);
    draw_line(image, camera, later_V, earlier_V, palette::kLoop, width);
    // A line without length that is wider than long is a dot.
    for (const Eigen::Vector3d& p_V : {later_V, earlier_V}) {
      draw_line(image, camera, p_V, p_V, palette::kLoop, 4 * width);
    }
  }
}

void draw_frustum(cv::Mat3b& image, const VirtualCamera& camera, const Frustum& frustum) {
  const Pose X_VW = camera.X_WV.inverse();
  const int width = line_width(image);
  const auto draw = [&](const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W) {
    draw_line(image, camera, X_VW * a_W, X_VW * b_W, palette::kCameraFrustum, width);
  };
  for (std::size_t i = 0; i < frustum.base_W.size(); ++i) {
    draw(frustum.apex_W, frustum.base_W[i]);
    draw(frustum.base_W[i], frustum.base_W[(i + 1) % frustum.base_W.size()]);
  }
}

void draw_caption(cv::Mat3b& image, const cv::Rect& bar, const std::string& text) {
  cv::rectangle(image, bar, palette::kCaptionBar, cv::FILLED);
  const cv::Size unit = text_size(text, 1.0);
  const double scale = std::min(0.018 * bar.height, (bar.width - 20.0) / std::max(unit.width, 1));
  const int y = bar.y + (bar.height + static_cast<int>(scale * unit.height)) / 2;
  draw_text(image, text, {bar.x + 10, y}, scale, palette::kCaptionText);
}

void draw_title(cv::Mat3b& image, const std::string& text) {
  const cv::Rect box = title_box(image, text);
  draw_outlined_text(image, text, {box.x, box.br().y}, title_scale(image));
}

cv::Rect title_box(const cv::Mat3b& image, const std::string& text) {
  const double scale = title_scale(image);
  return {10, 10, text_size(text, scale).width, static_cast<int>(22 * scale)};
}

}  // namespace kintsugi::viewer

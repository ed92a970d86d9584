#include "viewer/core/figure/panel.hpp"

#include <utility>

#include <opencv2/imgproc.hpp>

namespace kintsugi::viewer {
namespace {

/// The same camera with `factor` times as many pixels along each side.
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

}  // namespace

Panel::Panel(std::vector<PointChunk> chunks, const VirtualCamera& camera, const SplatConfig& config,
             int supersampling, const Highlight& highlight)
    : chunks_(std::move(chunks)),
      camera_(camera),
      supersampling_(supersampling),
      highlight_(highlight),
      fine_camera_(supersampled(camera, supersampling)),
      visible_(splat_points(chunks_, fine_camera_, config)) {}

cv::Mat3b Panel::draw(Coloring coloring) const {
  cv::Mat3b fine = shade(visible_, chunks_, fine_camera_, coloring, highlight_);
  if (!highlight_.empty()) {
    cv::Mat1b mask(fine.size(), std::uint8_t{0});
    for (int v = 0; v < mask.rows; ++v) {
      for (int u = 0; u < mask.cols; ++u) {
        if (highlight_.contains(segment_at(u, v))) mask(v, u) = 255;
      }
    }
    outline(fine, mask, supersampling_);
  }
  cv::Mat3b image;
  const cv::Size size(camera_.intrinsics.width, camera_.intrinsics.height);
  cv::resize(fine, image, size, 0.0, 0.0, cv::INTER_AREA);
  return image;
}

IdImage Panel::segment_ids() const {
  IdImage ids(camera_.intrinsics.height, camera_.intrinsics.width);
  for (int v = 0; v < ids.rows; ++v) {
    for (int u = 0; u < ids.cols; ++u) {
      ids(v, u) = static_cast<std::int32_t>(segment_at(u * supersampling_, v * supersampling_));
    }
  }
  return ids;
}

std::uint32_t Panel::segment_at(int u, int v) const {
  if (visible_.empty(u, v)) return kNoSegment;
  return chunks_[visible_.chunk(u, v)].labels[visible_.point(u, v)];
}

}  // namespace kintsugi::viewer

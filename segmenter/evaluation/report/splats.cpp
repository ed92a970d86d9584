#include "segmenter/evaluation/report/splats.hpp"

#include <limits>

namespace kintsugi::segmenter {

cv::Mat3b draw_splats(std::span<const Splat> splats, const SplatView& view) {
  cv::Mat3b picture(view.size, cv::Vec3b(255, 255, 255));
  cv::Mat1f depth(view.size, std::numeric_limits<float>::infinity());
  const int side_px = 2 * view.radius_px + 1;
  for (const Splat& splat : splats) {
    const Eigen::Vector2f at_px = view.px_per_m * (splat.position.head<2>() - view.corner);
    const int u = view.margin_px + static_cast<int>(at_px.x());
    const int v = view.margin_px + static_cast<int>(at_px.y());
    const cv::Rect square = cv::Rect(u - view.radius_px, v - view.radius_px, side_px, side_px) &
                            cv::Rect({0, 0}, view.size);
    for (int y = square.y; y < square.br().y; ++y) {
      for (int x = square.x; x < square.br().x; ++x) {
        if (splat.position.z() >= depth(y, x)) continue;
        depth(y, x) = splat.position.z();
        picture(y, x) = splat.color;
      }
    }
  }
  return picture;
}

}  // namespace kintsugi::segmenter

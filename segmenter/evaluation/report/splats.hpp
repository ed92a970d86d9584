#pragma once
// Draws points in parallel projection.

#include <Eigen/Core>
#include <span>

#include <opencv2/core.hpp>

namespace kintsugi::segmenter {

/// A point of a picture: x right, y down, z away from the viewer; metres.
struct Splat {
  Eigen::Vector3f position;
  cv::Vec3b color;  ///< blue, green, red
};

struct SplatView {
  Eigen::Vector2f corner = Eigen::Vector2f::Zero();  ///< of the picture, inside its margin; metres
  float px_per_m = 1.0F;
  cv::Size size;  ///< with the margin
  int margin_px = 0;
  int radius_px = 0;  ///< each point is a square of 2 radius + 1
};

/// Of several points at a pixel the nearest is drawn, of those as near the first; white elsewhere.
cv::Mat3b draw_splats(std::span<const Splat> splats, const SplatView& view);

}  // namespace kintsugi::segmenter

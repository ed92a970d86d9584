#include "viewer/core/figure/line.hpp"

#include <algorithm>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace kintsugi::viewer {

int line_width(const cv::Mat3b& image) { return std::max(1, (image.cols + 320) / 640); }

cv::Point2d project(const Intrinsics& k, const Eigen::Vector3d& p_V) {
  return {k.fx * p_V.x() / p_V.z() + k.cx, k.fy * p_V.y() / p_V.z() + k.cy};
}

void draw_line(cv::Mat3b& image, const VirtualCamera& camera, Eigen::Vector3d a_V,
               Eigen::Vector3d b_V, const Rgb& color, int width) {
  constexpr double kNear_m = 0.05;
  if (a_V.z() > b_V.z()) std::swap(a_V, b_V);
  if (b_V.z() <= kNear_m) return;
  if (a_V.z() < kNear_m) a_V += (b_V - a_V) * (kNear_m - a_V.z()) / (b_V.z() - a_V.z());

  constexpr int kShift = 4;  // OpenCV takes fixed-point coordinates: sixteenths of a pixel
  const auto fixed = [](const cv::Point2d& p) {
    // An end far outside the picture would overflow an int.
    const auto bounded = [](double t) { return std::clamp(t, -1e6, 1e6) * (1 << kShift); };
    return cv::Point(cv::Point2d(bounded(p.x), bounded(p.y)));
  };
  cv::line(image, fixed(project(camera.intrinsics, a_V)), fixed(project(camera.intrinsics, b_V)),
           color, width, cv::LINE_AA, kShift);
}

}  // namespace kintsugi::viewer

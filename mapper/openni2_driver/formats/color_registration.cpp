#include "mapper/openni2_driver/formats/color_registration.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace kintsugi::mapper {
namespace {

cv::Matx33d camera_matrix(const Intrinsics& camera) {
  return {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
}

std::vector<double> distortion(const Intrinsics& camera) {
  return {camera.distortion.begin(), camera.distortion.end()};
}

cv::Mat_<cv::Vec3f> rays_of(const Intrinsics& camera) {
  std::vector<cv::Point2f> pixels;
  pixels.reserve(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      pixels.emplace_back(static_cast<float>(x), static_cast<float>(y));
    }
  }
  std::vector<cv::Point2f> undistorted;
  cv::undistortPoints(pixels, undistorted, camera_matrix(camera), distortion(camera));
  cv::Mat_<cv::Vec3f> rays(camera.height, camera.width);
  std::ranges::transform(undistorted, rays.begin(),
                         [](const cv::Point2f& p) { return cv::Vec3f(p.x, p.y, 1.0F); });
  return rays;
}

/// In the middle of those that are valid; 1 m when none is.
float median_depth_m(const cv::Mat_<float>& depth_m) {
  std::vector<float> valid;
  valid.reserve(depth_m.total());
  std::ranges::copy_if(depth_m, std::back_inserter(valid), [](float z) { return z > 0.0F; });
  if (valid.empty()) return 1.0F;
  const auto middle = valid.begin() + static_cast<std::ptrdiff_t>(valid.size() / 2);
  std::ranges::nth_element(valid, middle);
  return *middle;
}

/// Of several colour pixels in one of depth their mean counts.
cv::Size smaller_size(const Intrinsics& depth, const Intrinsics& color) {
  const double shrink = std::max(1.0, std::abs(color.fx / depth.fx));
  const auto side = [&](int pixels) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(pixels) / shrink)));
  };
  return {side(color.width), side(color.height)};
}

}  // namespace

ColorRegistration::ColorRegistration(const Intrinsics& depth_camera,
                                     const ColorCamera& color_camera)
    : color_camera_(color_camera),
      smaller_(smaller_size(depth_camera, color_camera.intrinsics)),
      needs_depth_(!color_camera.X_RC.translation().isZero(1e-6)),
      rays_C_(rays_of(depth_camera)) {
  if (!needs_depth_) fixed_pixels_R_ = pixels_R(cv::Mat_<float>(rays_C_.size(), 1.0F));
}

/// The pixel of the smaller colour image that each pixel of the depth camera sees.
cv::Mat_<cv::Vec2f> ColorRegistration::pixels_R(const cv::Mat_<float>& depth_m) const {
  const float median_m = median_depth_m(depth_m);
  const Eigen::Isometry3f X_RC = color_camera_.X_RC.cast<float>();
  constexpr float kBehind = -1e6F;  // in front of no camera: outside of the image
  std::vector<cv::Point3f> points_R;
  points_R.reserve(rays_C_.total());
  auto depth = depth_m.begin();
  for (const cv::Vec3f& ray : rays_C_) {
    const float z = *depth > 0.0F ? *depth : median_m;
    ++depth;
    const Eigen::Vector3f p_R = X_RC * (z * Eigen::Vector3f(ray[0], ray[1], ray[2]));
    points_R.emplace_back(p_R.x(), p_R.y(), p_R.z());
  }
  std::vector<cv::Point2f> pixels;
  const Intrinsics& camera = color_camera_.intrinsics;
  cv::projectPoints(points_R, cv::Vec3d(), cv::Vec3d(), camera_matrix(camera), distortion(camera),
                    pixels);
  cv::Mat_<cv::Vec2f> result(rays_C_.size());
  const float x_scale = static_cast<float>(smaller_.width) / static_cast<float>(camera.width);
  const float y_scale = static_cast<float>(smaller_.height) / static_cast<float>(camera.height);
  auto point = points_R.begin();
  std::ranges::transform(pixels, result.begin(), [&](const cv::Point2f& pixel) {
    const bool in_front = (point++)->z > 0.0F;
    if (!in_front) return cv::Vec2f(kBehind, kBehind);
    return cv::Vec2f((pixel.x + 0.5F) * x_scale - 0.5F, (pixel.y + 0.5F) * y_scale - 0.5F);
  });
  return result;
}

cv::Mat_<cv::Vec3b> ColorRegistration::apply(const cv::Mat_<cv::Vec3b>& color,
                                             const cv::Mat_<float>& depth_m) const {
  cv::Mat smaller = color;
  if (smaller_ != color.size()) cv::resize(color, smaller, smaller_, 0.0, 0.0, cv::INTER_AREA);
  cv::Mat_<cv::Vec3b> registered;
  cv::remap(smaller, registered, needs_depth_ ? pixels_R(depth_m) : fixed_pixels_R_, cv::noArray(),
            cv::INTER_LINEAR);
  return registered;
}

}  // namespace kintsugi::mapper

#include "segmenter/evaluation/report/map_picture.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "lcmtypes/base/argument_check.hpp"
#include "segmenter/evaluation/report/label_color.hpp"
#include "segmenter/evaluation/report/splats.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr int kLongerSide_px = 1200;
constexpr int kMargin_px = 10;
constexpr double kPitch_rad = 55.0 * std::numbers::pi / 180.0;  // down from the horizon
constexpr double kYaw_rad = -25.0 * std::numbers::pi / 180.0;
constexpr double kDarkest = 0.45;  // of surfaces seen at a grazing angle

/// Rotation from W to the picture: x right, y down, z away from the viewer.
Eigen::Matrix3f rotation_to_picture() {
  const Eigen::AngleAxisd pitch(kPitch_rad, Eigen::Vector3d::UnitX());
  const Eigen::AngleAxisd yaw(kYaw_rad, Eigen::Vector3d::UnitY());
  return (pitch * yaw).toRotationMatrix().cast<float>();
}

/// The share of points seen from the front below which nothing is known of front and back, as in a
/// cloud whose normals were computed.
constexpr double kLeastShareInFront = 0.2;

std::vector<Splat> splats_of(std::span<const CloudPoint> points_W,
                             std::span<const std::uint32_t> labels, bool from_behind_too) {
  const Eigen::Matrix3f R = rotation_to_picture();
  std::vector<Splat> splats;
  splats.reserve(points_W.size());
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    const CloudPoint& p = points_W[i];
    const float towards_viewer = -(R * Eigen::Vector3f(p.nx, p.ny, p.nz)).z();
    if (towards_viewer < 0.0F && !from_behind_too) continue;
    const double shade = kDarkest + (1.0 - kDarkest) * std::abs(towards_viewer);
    splats.push_back({R * Eigen::Vector3f(p.x, p.y, p.z), shade * color_of_label(labels[i])});
  }
  return splats;
}

cv::Mat3b draw(const std::vector<Splat>& splats, float resolution_m) {
  Eigen::AlignedBox3f box;
  for (const Splat& splat : splats) box.extend(splat.position);
  const Eigen::Vector2f extent_m = box.sizes().head<2>().cwiseMax(resolution_m);
  const float px_per_m = kLongerSide_px / extent_m.maxCoeff();
  const auto side_px = [&](float m) {
    return static_cast<int>(std::ceil(m * px_per_m)) + 2 * kMargin_px;
  };
  const int radius_px =
      std::clamp(static_cast<int>(std::ceil(0.6F * resolution_m * px_per_m)), 0, kMargin_px);
  return draw_splats(splats, {.corner = box.min().head<2>(),
                              .px_per_m = px_per_m,
                              .size = {side_px(extent_m.x()), side_px(extent_m.y())},
                              .margin_px = kMargin_px,
                              .radius_px = radius_px});
}

}  // namespace

std::string map_picture_png(std::span<const CloudPoint> points_W,
                            std::span<const std::uint32_t> labels, float resolution_m) {
  require(points_W.size() == labels.size(), "number of labels", labels.size(),
          std::to_string(points_W.size()) + ", one for each point");
  if (points_W.empty()) return "";
  std::vector<Splat> splats = splats_of(points_W, labels, false);
  const auto least = kLeastShareInFront * static_cast<double>(points_W.size());
  if (static_cast<double>(splats.size()) < least) splats = splats_of(points_W, labels, true);
  std::vector<unsigned char> png;
  cv::imencode(".png", draw(splats, resolution_m), png);
  return {png.begin(), png.end()};
}

}  // namespace kintsugi::segmenter

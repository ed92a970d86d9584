#include "segmenter/objects/changes/change_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "lcmtypes/scene/up_direction.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"
#include "segmenter/objects/model/shortest_rotation.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr int kLongerSide_px = 1400;
constexpr int kMargin_px = 30;
constexpr double kPitch_rad = 60.0 * std::numbers::pi / 180.0;  // down from the horizon
constexpr double kYaw_rad = -25.0 * std::numbers::pi / 180.0;
constexpr float kDarkest = 0.45F;  // of surfaces seen at a grazing angle

const cv::Vec3f kGreen(40, 190, 40);  // blue, green, red
const cv::Vec3f kRed(40, 40, 230);
const cv::Vec3f kBlue(240, 90, 20);
const cv::Vec3f kLightBlue(255, 200, 150);

/// From W to the picture: x right, y down, z away from the viewer.
Eigen::Matrix3f rotation_to_picture(const Eigen::Vector3d& up_W) {
  const Eigen::Quaterniond level = shortest_rotation(up_W, -Eigen::Vector3d::UnitY());
  const Eigen::AngleAxisd pitch(kPitch_rad, Eigen::Vector3d::UnitX());
  const Eigen::AngleAxisd yaw(kYaw_rad, Eigen::Vector3d::UnitY());
  return (pitch * yaw * level).toRotationMatrix().cast<float>();
}

struct Splat {
  Eigen::Vector3f position;
  cv::Vec3f color;
};

class Painter {
 public:
  explicit Painter(const Eigen::Vector3d& up_W) : R_(rotation_to_picture(up_W)) {}

  void add(const CloudPoint& point, const cv::Vec3f& color, bool from_behind_too) {
    const float towards_viewer = -(R_ * normal_of(point)).z();
    if (towards_viewer < 0.0F && !from_behind_too) return;
    const float shade = kDarkest + (1.0F - kDarkest) * std::abs(towards_viewer);
    const Eigen::Vector3f at = R_ * position_of(point);
    splats_.push_back({at, shade * color});
    box_.extend(at);
  }

  void add_text(const std::string& text, const Eigen::Vector3f& p_W) {
    texts_.push_back({text, R_ * p_W});
  }

  [[nodiscard]] cv::Mat3b draw(float resolution_m) const {
    const Eigen::Vector2f extent_m = box_.sizes().head<2>().cwiseMax(resolution_m);
    const float px_per_m = kLongerSide_px / extent_m.maxCoeff();
    const auto side_px = [&](float m) {
      return static_cast<int>(std::ceil(m * px_per_m)) + 2 * kMargin_px;
    };
    cv::Mat3b picture(side_px(extent_m.y()), side_px(extent_m.x()), cv::Vec3b(255, 255, 255));
    cv::Mat1f depth(picture.size(), std::numeric_limits<float>::infinity());
    const int radius_px =
        std::clamp(static_cast<int>(std::ceil(0.6F * resolution_m * px_per_m)), 0, kMargin_px);
    const auto pixel_of = [&](const Eigen::Vector3f& at) {
      const Eigen::Vector3f from_corner = px_per_m * (at - box_.min());
      return cv::Point(kMargin_px + static_cast<int>(from_corner.x()),
                       kMargin_px + static_cast<int>(from_corner.y()));
    };
    for (const Splat& splat : splats_) {
      const cv::Point center = pixel_of(splat.position);
      const cv::Rect square = cv::Rect(center.x - radius_px, center.y - radius_px,
                                       2 * radius_px + 1, 2 * radius_px + 1) &
                              cv::Rect({0, 0}, picture.size());
      for (int y = square.y; y < square.br().y; ++y) {
        for (int x = square.x; x < square.br().x; ++x) {
          if (splat.position.z() >= depth(y, x)) continue;
          depth(y, x) = splat.position.z();
          picture(y, x) = splat.color;
        }
      }
    }
    for (const Text& text : texts_) {
      cv::putText(picture, text.text, pixel_of(text.position), cv::FONT_HERSHEY_SIMPLEX, 0.6,
                  {0, 0, 0}, 2, cv::LINE_AA);
    }
    return picture;
  }

 private:
  struct Text {
    std::string text;
    Eigen::Vector3f position;
  };

  Eigen::Matrix3f R_;
  std::vector<Splat> splats_;
  std::vector<Text> texts_;
  Eigen::AlignedBox3f box_;
};

void paint(const MapChange& change, Painter& painter) {
  const bool has_moved = change.kind == ChangeKind::kMoved;
  for (const CloudPoint& point : change.before) {
    painter.add(point, has_moved ? kLightBlue : kRed, true);
  }
  for (const CloudPoint& point : change.after) {
    painter.add(point, has_moved ? kBlue : kGreen, true);
  }
  Eigen::AlignedBox3f box;
  for (const CloudPoint& point : change.points()) box.extend(position_of(point));
  painter.add_text(std::to_string(change.id), box.center());
}

cv::Vec3f grey_of(const CloudPoint& point) {
  const float brightness = (point.red + point.green + point.blue) / 3.0F;
  const float level = 120.0F + 0.5F * brightness;  // light: the changes stand out
  return {level, level, level};
}

}  // namespace

std::string change_picture_png(std::span<const MapChange> changes, const ObservedMap& after) {
  UpDirection up;
  up.add(after.points_W);
  Painter painter(up.up_W());
  // Changes first: of two points at one place the first is drawn.
  for (const MapChange& change : changes) paint(change, painter);
  for (const CloudPoint& point : after.points_W) painter.add(point, grey_of(point), false);
  std::vector<unsigned char> png;
  cv::imencode(".png", painter.draw(after.resolution_m), png);
  return {png.begin(), png.end()};
}

}  // namespace kintsugi::segmenter

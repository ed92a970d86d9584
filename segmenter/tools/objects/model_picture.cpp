#include "segmenter/tools/objects/model_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <spdlog/fmt/fmt.h>

#include "lcmtypes/base/atomic_file.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr int kPanel_px = 400;
constexpr int kMargin_px = 30;
constexpr int kCaption_px = 40;

/// From where a panel is drawn: the axes of O that go right, up and towards the one who looks.
struct Side {
  const char* title;
  Eigen::Vector3f right;
  Eigen::Vector3f up;

  Eigen::Vector3f towards() const { return right.cross(up); }
};

std::array<Side, 3> sides_of(const ObjectModel& model) {
  const Eigen::Vector3f x = Eigen::Vector3f::UnitX();
  const Eigen::Vector3f y = Eigen::Vector3f::UnitY();
  const Eigen::Vector3f z = Eigen::Vector3f::UnitZ();
  if (model.has_up) {
    return {Side{"from -y", x, z}, Side{"from x", y, z}, Side{"from above (z)", x, y}};
  }
  // Axes of a map: y is about down.
  return {Side{"from -z", x, -y}, Side{"from x", z, -y}, Side{"from -y", x, z}};
}

Eigen::AlignedBox3f box_of(const ObjectModel& model) {
  Eigen::AlignedBox3f box_O;
  for (const CloudPoint& p : model.points_O) box_O.extend(Eigen::Vector3f(p.x, p.y, p.z));
  return box_O;
}

/// Points without colour are grey; what faces away from the one who looks is darker.
cv::Vec3b color_of(const CloudPoint& p, float facing) {
  const bool has_color = p.red != 0 || p.green != 0 || p.blue != 0;
  const Eigen::Vector3f bgr =
      has_color ? Eigen::Vector3f(p.blue, p.green, p.red) : Eigen::Vector3f::Constant(180.0F);
  const float light = 0.55F + 0.45F * std::max(0.0F, facing);
  return {static_cast<std::uint8_t>(light * bgr.x()), static_cast<std::uint8_t>(light * bgr.y()),
          static_cast<std::uint8_t>(light * bgr.z())};
}

/// Each point is a square as wide as the spacing; the nearest counts.
void draw_side(const ObjectModel& model, const Side& side, const Eigen::Vector3f& center_O,
               float px_per_m, cv::Mat_<cv::Vec3b> panel) {
  cv::Mat_<float> nearest(panel.rows, panel.cols, -std::numeric_limits<float>::infinity());
  const int half = std::clamp(static_cast<int>(0.75F * model.resolution_m * px_per_m), 1, 50);
  const Eigen::Vector3f towards = side.towards();
  for (const CloudPoint& p : model.points_O) {
    const Eigen::Vector3f offset = Eigen::Vector3f(p.x, p.y, p.z) - center_O;
    const float facing = towards.dot(Eigen::Vector3f(p.nx, p.ny, p.nz));
    const int u = panel.cols / 2 + static_cast<int>(std::lround(px_per_m * side.right.dot(offset)));
    const int v = panel.rows / 2 - static_cast<int>(std::lround(px_per_m * side.up.dot(offset)));
    const float depth = towards.dot(offset);
    const cv::Rect square =
        cv::Rect(u - half, v - half, 2 * half + 1, 2 * half + 1) & cv::Rect({}, panel.size());
    for (int row = square.y; row < square.y + square.height; ++row) {
      for (int column = square.x; column < square.x + square.width; ++column) {
        if (depth <= nearest(row, column)) continue;
        nearest(row, column) = depth;
        panel(row, column) = color_of(p, facing);
      }
    }
  }
}

void write(cv::Mat& image, const std::string& text, const cv::Point& place) {
  cv::putText(image, text, place, cv::FONT_HERSHEY_SIMPLEX, 0.45, cv::Scalar::all(30), 1,
              cv::LINE_AA);
}

/// The largest of 1, 2, 5, 10, ... cm that fits.
float bar_length_m(float longest_m) {
  float length_m = 0.01F;
  for (const float factor : {2.0F, 2.5F, 2.0F, 2.0F, 2.5F, 2.0F, 2.0F, 2.5F, 2.0F}) {
    if (length_m * factor > longest_m) break;
    length_m *= factor;
  }
  return length_m;
}

cv::Mat drawn(const ObjectModel& model) {
  const Eigen::AlignedBox3f box_O = box_of(model);
  const float longest_m = std::max(box_O.sizes().maxCoeff(), model.resolution_m);
  const float px_per_m = static_cast<float>(kPanel_px - 2 * kMargin_px) / longest_m;
  cv::Mat_<cv::Vec3b> image(kPanel_px + kCaption_px, 3 * kPanel_px, cv::Vec3b(255, 255, 255));
  const std::array<Side, 3> sides = sides_of(model);
  for (int i = 0; i < 3; ++i) {
    const Side& side = sides[static_cast<std::size_t>(i)];
    draw_side(model, side, box_O.center(), px_per_m,
              image(cv::Rect(i * kPanel_px, 0, kPanel_px, kPanel_px)));
    write(image, side.title, {i * kPanel_px + 8, 16});
  }
  const float bar_m = bar_length_m(longest_m / 2);
  const int bar_px = static_cast<int>(std::lround(bar_m * px_per_m));
  const int baseline = kPanel_px + kCaption_px / 2;
  cv::rectangle(image, cv::Rect(8, baseline - 3, bar_px, 4), cv::Scalar::all(30), cv::FILLED);
  write(image,
        fmt::format("{:g} cm    {}: {} points", std::round(100.0F * bar_m), model.name,
                    model.points_O.size()),
        {16 + bar_px, baseline + 3});
  return image;
}

}  // namespace

void write_model_picture(const ObjectModel& model, const std::filesystem::path& path) {
  std::vector<std::uint8_t> png;
  cv::imencode(".png", drawn(model), png);
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(png.data()), std::ssize(png));
  file.commit();
}

}  // namespace kintsugi::segmenter

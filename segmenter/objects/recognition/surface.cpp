#include "segmenter/objects/recognition/surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace kintsugi::segmenter {

namespace {

using Cube = std::array<std::int32_t, 3>;

struct PlacedPoint {
  Cube cube;
  const CloudPoint* point;
};

/// Black means that a point has no colour, see segmenter/README.md.
bool has_color(const CloudPoint& p) { return p.red != 0 || p.green != 0 || p.blue != 0; }

std::vector<PlacedPoint> placed(std::span<const CloudPoint> points, float spacing_m) {
  std::vector<PlacedPoint> placed;
  placed.reserve(points.size());
  const auto cell = [spacing_m](float x) {
    return static_cast<std::int32_t>(std::floor(x / spacing_m));
  };
  for (const CloudPoint& p : points) {
    if (p.nx == 0.0F && p.ny == 0.0F && p.nz == 0.0F) continue;
    placed.push_back({{cell(p.x), cell(p.y), cell(p.z)}, &p});
  }
  // The sums below are of floats: their order must not depend on that of the points.
  std::sort(placed.begin(), placed.end(), [](const PlacedPoint& a, const PlacedPoint& b) {
    if (a.cube != b.cube) return a.cube < b.cube;
    return std::array{a.point->x, a.point->y, a.point->z} <
           std::array{b.point->x, b.point->y, b.point->z};
  });
  return placed;
}

struct Sums {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  Eigen::Vector3f rgb = Eigen::Vector3f::Zero();
  float count = 0.0F;
  float colors = 0.0F;

  void add(const CloudPoint& p) {
    position += Eigen::Vector3f(p.x, p.y, p.z);
    normal += Eigen::Vector3f(p.nx, p.ny, p.nz);
    count += 1.0F;
    if (!has_color(p)) return;
    rgb += Eigen::Vector3f(p.red, p.green, p.blue);
    colors += 1.0F;
  }
};

/// Fills `lab` of each point from the colour, 0 to 255, that is there.
void convert_to_lab(Surface& surface) {
  if (surface.empty()) return;
  cv::Mat_<cv::Vec3f> rgb(static_cast<int>(surface.size()), 1);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const Eigen::Vector3f c = surface[i].lab / 255.0F;
    rgb(static_cast<int>(i)) = {c.x(), c.y(), c.z()};
  }
  cv::Mat_<cv::Vec3f> lab;
  cv::cvtColor(rgb, lab, cv::COLOR_RGB2Lab);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const cv::Vec3f& c = lab(static_cast<int>(i));
    surface[i].lab = {c[0], c[1], c[2]};
  }
}

}  // namespace

Surface thinned(std::span<const CloudPoint> points, float spacing_m) {
  const std::vector<PlacedPoint> by_cube = placed(points, spacing_m);
  Surface surface;
  for (std::size_t first = 0; first < by_cube.size();) {
    Sums sums;
    std::size_t i = first;
    for (; i < by_cube.size() && by_cube[i].cube == by_cube[first].cube; ++i) {
      sums.add(*by_cube[i].point);
    }
    first = i;
    const float length = sums.normal.norm();
    // A mean of unit normals this short has no direction: the cube holds both sides of a thin
    // thing.
    if (length < 0.1F * sums.count) continue;
    SurfacePoint& point = surface.emplace_back();
    point.position = sums.position / sums.count;
    point.normal = sums.normal / length;
    point.has_color = sums.colors > 0.0F;
    if (point.has_color) point.lab = sums.rgb / sums.colors;
  }
  convert_to_lab(surface);
  return surface;
}

Surface unthinned(std::span<const CloudPoint> points) {
  Surface surface;
  surface.reserve(points.size());
  for (const CloudPoint& p : points) {
    SurfacePoint& point = surface.emplace_back();
    point.position = {p.x, p.y, p.z};
    point.normal = {p.nx, p.ny, p.nz};
    point.has_color = has_color(p);
    if (point.has_color) point.lab = Eigen::Vector3f(p.red, p.green, p.blue);
  }
  convert_to_lab(surface);
  return surface;
}

Surface transformed(const Surface& surface_A, const Pose& X_BA) {
  const Eigen::Isometry3f X = X_BA.cast<float>();
  Surface surface_B = surface_A;
  for (SurfacePoint& point : surface_B) {
    point.position = X * point.position;
    point.normal = X.linear() * point.normal;
  }
  return surface_B;
}

float radius_of(const Surface& surface) {
  if (surface.empty()) return 0.0F;
  Eigen::Vector3f low = surface.front().position;
  Eigen::Vector3f high = low;
  for (const SurfacePoint& point : surface) {
    low = low.cwiseMin(point.position);
    high = high.cwiseMax(point.position);
  }
  return (high - low).norm() / 2;
}

Surface every_few(const Surface& surface, std::size_t count) {
  if (surface.size() <= count || count == 0) return surface;
  Surface chosen;
  chosen.reserve(count);
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(surface[i * surface.size() / count]);
  return chosen;
}

}  // namespace kintsugi::segmenter

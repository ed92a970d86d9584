#include "segmenter/objects/recognition/surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kintsugi::segmenter {

namespace {

using Cube = std::array<std::int32_t, 3>;

// Patterns are averaged over about twelve points.
constexpr float kColorRadius = 2.0F;  // spacings

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

/// sRGB's transfer function (IEC 61966-2-1), by value.
const std::array<float, 256>& linear_values() {
  static const std::array<float, 256> kValues = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const float v = static_cast<float>(i) / 255.0F;
      values[i] = v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
    }
    return values;
  }();
  return kValues;
}

Eigen::Vector3f linear_rgb_of(const CloudPoint& p) {
  const std::array<float, 256>& values = linear_values();
  return {values[p.red], values[p.green], values[p.blue]};
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
    rgb += linear_rgb_of(p);
    colors += 1.0F;
  }
};

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
    if (point.has_color) point.rgb = sums.rgb / sums.colors;
  }
  smooth_colors(surface, kColorRadius * spacing_m);
  return surface;
}

Surface unthinned(std::span<const CloudPoint> points, float spacing_m) {
  Surface surface;
  surface.reserve(points.size());
  for (const CloudPoint& p : points) {
    SurfacePoint& point = surface.emplace_back();
    point.position = {p.x, p.y, p.z};
    point.normal = {p.nx, p.ny, p.nz};
    point.has_color = has_color(p);
    if (point.has_color) point.rgb = linear_rgb_of(p);
  }
  smooth_colors(surface, kColorRadius * spacing_m);
  return surface;
}

void smooth_colors(Surface& surface, float radius_m) {
  if (surface.empty()) return;
  struct Cell {
    Cube cube;
    std::size_t point;
  };
  const auto cube_of = [radius_m](const Eigen::Vector3f& p) {
    const Eigen::Vector3i cube = (p / radius_m).array().floor().cast<int>();
    return Cube{cube.x(), cube.y(), cube.z()};
  };
  std::vector<Cell> cells;
  cells.reserve(surface.size());
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (surface[i].has_color) cells.push_back({cube_of(surface[i].position), i});
  }
  std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) {
    return a.cube != b.cube ? a.cube < b.cube : a.point < b.point;
  });
  const auto before = [](const Cell& cell, const Cube& cube) { return cell.cube < cube; };
  std::vector<Eigen::Vector3f> means(surface.size());
  for (const Cell& cell : cells) {
    const Eigen::Vector3f& p = surface[cell.point].position;
    const Eigen::Vector3f& n = surface[cell.point].normal;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float count = 0.0F;
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        // Three cubes along z follow each other.
        const Cube first{cell.cube[0] + x, cell.cube[1] + y, cell.cube[2] - 1};
        for (auto at = std::lower_bound(cells.begin(), cells.end(), first, before);
             at != cells.end() && at->cube[0] == first[0] && at->cube[1] == first[1] &&
             at->cube[2] <= cell.cube[2] + 1;
             ++at) {
          const SurfacePoint& other = surface[at->point];
          if ((other.position - p).squaredNorm() > radius_m * radius_m) continue;
          if (other.normal.dot(n) < kSameNormal && at->point != cell.point) continue;
          sum += other.rgb;
          count += 1.0F;
        }
      }
    }
    means[cell.point] = sum / count;
  }
  for (const Cell& cell : cells) {
    surface[cell.point].rgb = means[cell.point];
    surface[cell.point].lab = lab_of(means[cell.point]);
  }
}

Eigen::Vector3f lab_of(const Eigen::Vector3f& linear_rgb) {
  // sRGB to XYZ relative to D65, so that white is (1, 1, 1).
  Eigen::Matrix3f M;
  M << 0.433953F, 0.376219F, 0.189828F,  //
      0.212671F, 0.715160F, 0.072169F,   //
      0.017758F, 0.109477F, 0.872766F;
  Eigen::Vector3f f = M * linear_rgb;
  for (int k = 0; k < 3; ++k) {
    f[k] = f[k] > 0.008856F ? std::cbrt(f[k]) : 7.787F * f[k] + 16.0F / 116.0F;
  }
  return {116.0F * f.y() - 16.0F, 500.0F * (f.x() - f.y()), 200.0F * (f.y() - f.z())};
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

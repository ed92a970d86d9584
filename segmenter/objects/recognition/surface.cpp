#include "segmenter/objects/recognition/surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kintsugi::segmenter {

namespace {

using Cube = std::array<std::int32_t, 3>;

Cube cube_of(const Eigen::Vector3f& p, float side_m) {
  const Eigen::Vector3i cube = (p / side_m).array().floor().cast<int>();
  return {cube.x(), cube.y(), cube.z()};
}

Eigen::Vector3f position_of(const CloudPoint& p) { return {p.x, p.y, p.z}; }
Eigen::Vector3f position_of(const SurfacePoint& p) { return p.position; }

bool has_normal(const CloudPoint& p) { return p.nx != 0.0F || p.ny != 0.0F || p.nz != 0.0F; }
bool has_normal(const SurfacePoint& p) { return !p.normal.isZero(0.0F); }

/// Black means that a point has no colour, see segmenter/README.md.
bool has_color(const CloudPoint& p) { return p.red != 0 || p.green != 0 || p.blue != 0; }

template <class Point>
struct PlacedPoint {
  Cube cube;
  const Point* point;
};

template <class Point>
std::vector<PlacedPoint<Point>> placed(std::span<const Point> points, float spacing_m) {
  std::vector<PlacedPoint<Point>> placed;
  placed.reserve(points.size());
  for (const Point& p : points) {
    if (has_normal(p)) placed.push_back({cube_of(position_of(p), spacing_m), &p});
  }
  // The sums below are of floats: their order must not depend on that of the points.
  std::sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) {
    if (a.cube != b.cube) return a.cube < b.cube;
    const Eigen::Vector3f p = position_of(*a.point);
    const Eigen::Vector3f q = position_of(*b.point);
    return std::array{p.x(), p.y(), p.z()} < std::array{q.x(), q.y(), q.z()};
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

/// The value that is nearest.
std::uint8_t encoded(float linear) {
  const std::array<float, 256>& values = linear_values();
  const auto above = std::ranges::lower_bound(values, linear);
  if (above == values.begin()) return 0;
  const bool is_below_nearer =
      above == values.end() || linear - *std::prev(above) < *above - linear;
  return static_cast<std::uint8_t>(above - values.begin() - (is_below_nearer ? 1 : 0));
}

struct Sums {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  Eigen::Vector3f rgb = Eigen::Vector3f::Zero();
  float count = 0.0F;
  float colors = 0.0F;

  void add(const CloudPoint& p) {
    position += position_of(p);
    normal += Eigen::Vector3f(p.nx, p.ny, p.nz);
    count += 1.0F;
    if (!has_color(p)) return;
    rgb += linear_rgb_of(p);
    colors += 1.0F;
  }
  void add(const SurfacePoint& p) {
    position += p.position;
    normal += p.normal;
    count += 1.0F;
    if (!p.has_color) return;
    rgb += p.rgb;
    colors += 1.0F;
  }
};

/// One point for each cube, without CIELAB.
template <class Point>
Surface means_in_cubes(std::span<const Point> points, float spacing_m) {
  const std::vector<PlacedPoint<Point>> by_cube = placed(points, spacing_m);
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
  return surface;
}

Surface with_lab(Surface surface) {
  for (SurfacePoint& point : surface) {
    if (point.has_color) point.lab = lab_of(point.rgb);
  }
  return surface;
}

/// The points in each cube, and those in the 27 cubes around it.
class Neighbourhoods {
 public:
  Neighbourhoods(const Surface& surface, float cube_m) {
    cells_.reserve(surface.size());
    for (std::size_t i = 0; i < surface.size(); ++i) {
      if (surface[i].has_color) cells_.push_back({cube_of(surface[i].position, cube_m), i});
    }
    std::sort(cells_.begin(), cells_.end(), [](const Cell& a, const Cell& b) {
      return a.cube != b.cube ? a.cube < b.cube : a.point < b.point;
    });
  }

  /// Calls visit(points in the cube, points in and around it) for each cube with points.
  template <class Visit>
  void visit(const Visit& visit) const {
    std::vector<std::size_t> inside;
    std::vector<std::size_t> around;
    for (std::size_t first = 0; first < cells_.size();) {
      const Cube& cube = cells_[first].cube;
      inside.clear();
      std::size_t end = first;
      for (; end < cells_.size() && cells_[end].cube == cube; ++end) {
        inside.push_back(cells_[end].point);
      }
      gather_around(cube, around);
      visit(inside, around);
      first = end;
    }
  }

 private:
  struct Cell {
    Cube cube;
    std::size_t point;
  };

  void gather_around(const Cube& cube, std::vector<std::size_t>& around) const {
    around.clear();
    const auto before = [](const Cell& cell, const Cube& other) { return cell.cube < other; };
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        // Three cubes along z follow each other.
        const Cube first{cube[0] + x, cube[1] + y, cube[2] - 1};
        const Cube last{cube[0] + x, cube[1] + y, cube[2] + 1};
        for (auto at = std::lower_bound(cells_.begin(), cells_.end(), first, before);
             at != cells_.end() && at->cube <= last; ++at) {
          around.push_back(at->point);
        }
      }
    }
  }

  std::vector<Cell> cells_;
};

}  // namespace

Surface thinned(std::span<const CloudPoint> points, float spacing_m) {
  Surface surface = means_in_cubes(points, spacing_m);
  smooth_colors(surface, color_radius_m(spacing_m));
  return surface;
}

Surface roughly_thinned(std::span<const CloudPoint> points, float spacing_m) {
  return with_lab(means_in_cubes(points, spacing_m));
}

Surface thinned(const Surface& surface, float spacing_m) {
  return with_lab(means_in_cubes(std::span<const SurfacePoint>(surface), spacing_m));
}

Surface unthinned(std::span<const CloudPoint> points, float spacing_m) {
  Surface surface;
  surface.reserve(points.size());
  for (const CloudPoint& p : points) {
    SurfacePoint& point = surface.emplace_back();
    point.position = position_of(p);
    point.normal = {p.nx, p.ny, p.nz};
    point.has_color = has_color(p);
    if (point.has_color) point.rgb = linear_rgb_of(p);
  }
  smooth_colors(surface, color_radius_m(spacing_m));
  return surface;
}

void smooth_colors(Surface& surface, float radius_m) {
  std::vector<Eigen::Vector3f> means(surface.size());
  Neighbourhoods(surface, radius_m).visit([&](const auto& inside, const auto& around) {
    for (const std::size_t i : inside) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      float count = 0.0F;
      for (const std::size_t k : around) {
        const SurfacePoint& other = surface[k];
        if ((other.position - surface[i].position).squaredNorm() > radius_m * radius_m) continue;
        if (other.normal.dot(surface[i].normal) < kSameNormal && k != i) continue;
        sum += other.rgb;
        count += 1.0F;
      }
      means[i] = sum / count;
    }
  });
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (!surface[i].has_color) continue;
    surface[i].rgb = means[i];
    surface[i].lab = lab_of(means[i]);
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

void relight(Surface& surface, const Eigen::Array3f& gain) {
  if ((gain == 1.0F).all()) return;
  for (SurfacePoint& point : surface) {
    if (!point.has_color) continue;
    point.rgb.array() *= gain;
    point.lab = lab_of(point.rgb);
  }
}

void relight(std::span<CloudPoint> points, const Eigen::Array3f& gain) {
  for (CloudPoint& p : points) {
    const Eigen::Array3f rgb = linear_rgb_of(p).array() * gain;
    p.red = encoded(rgb.x());
    p.green = encoded(rgb.y());
    p.blue = encoded(rgb.z());
  }
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

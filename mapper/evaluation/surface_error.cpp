#include "mapper/evaluation/surface_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include <oneapi/tbb/parallel_for.h>

#include "mapper/synthetic/scene/scene.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kDensityRadius_m = 0.05;
constexpr std::size_t kDensitySamples = 2000;

Eigen::Vector3d position_W(const CloudPoint& p) { return {p.x, p.y, p.z}; }

/// The value that about `share` of them are not above, rounded down to one of them.
double percentile(std::vector<double> values, double share) {
  const auto index = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[index];
}

/// Away from the nearest surface; unit.
Eigen::Vector3d true_normal(const synthetic::Scene& scene, const Eigen::Vector3d& p_S) {
  constexpr double kStep_m = 1e-5;
  Eigen::Vector3d gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kStep_m * Eigen::Vector3d::Unit(axis);
    gradient[axis] = scene.signed_distance(p_S + step) - scene.signed_distance(p_S - step);
  }
  return gradient.normalized();
}

double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

/// Points by cells of a grid as wide as the radius.
class Grid {
 public:
  explicit Grid(const std::vector<CloudPoint>& points_W) : points_W_(points_W) {
    for (std::size_t i = 0; i < points_W.size(); ++i) {
      cells_[key(cell_of(points_W[i]))].push_back(i);
    }
  }

  int count_near(const CloudPoint& center) const {
    int count = 0;
    const std::array<std::int64_t, 3> cell = cell_of(center);
    for (int k = 0; k < 27; ++k) {
      const auto found =
          cells_.find(key({cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1}));
      if (found == cells_.end()) continue;
      for (const std::size_t i : found->second) {
        if ((position_W(points_W_[i]) - position_W(center)).norm() <= kDensityRadius_m) ++count;
      }
    }
    return count;
  }

 private:
  static std::array<std::int64_t, 3> cell_of(const CloudPoint& p) {
    const auto cell = [](float c) {
      return static_cast<std::int64_t>(std::floor(c / kDensityRadius_m));
    };
    return {cell(p.x), cell(p.y), cell(p.z)};
  }
  static std::int64_t key(const std::array<std::int64_t, 3>& cell) {
    constexpr std::int64_t kSpan = std::int64_t{1} << 20;
    return ((cell[0] + kSpan / 2) * kSpan + cell[1] + kSpan / 2) * kSpan + cell[2] + kSpan / 2;
  }

  const std::vector<CloudPoint>& points_W_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

double points_per_m2(const std::vector<CloudPoint>& points_W) {
  const Grid grid(points_W);
  const std::size_t step = std::max<std::size_t>(1, points_W.size() / kDensitySamples);
  std::vector<double> counts;
  for (std::size_t i = 0; i < points_W.size(); i += step) {
    counts.push_back(grid.count_near(points_W[i]));
  }
  return percentile(counts, 0.5) / (std::numbers::pi * kDensityRadius_m * kDensityRadius_m);
}

}  // namespace

std::vector<double> signed_errors_m(const std::vector<CloudPoint>& points_W,
                                    const synthetic::Scene& scene, const Pose& X_SW) {
  std::vector<double> errors_m(points_W.size());
  tbb::parallel_for(std::size_t{0}, points_W.size(), [&](std::size_t i) {
    errors_m[i] = scene.signed_distance(X_SW * position_W(points_W[i]));
  });
  return errors_m;
}

SurfaceError surface_error(const std::vector<CloudPoint>& points_W, const synthetic::Scene& scene,
                           const Pose& X_SW) {
  SurfaceError error;
  error.num_points = std::ssize(points_W);
  if (points_W.empty()) return error;
  std::vector<double> errors_m = signed_errors_m(points_W, scene, X_SW);
  for (double& e : errors_m) {
    e = std::abs(e);
    error.mean_m += e / static_cast<double>(points_W.size());
  }
  std::vector<double> angles_deg(points_W.size());
  tbb::parallel_for(std::size_t{0}, points_W.size(), [&](std::size_t i) {
    const CloudPoint& p = points_W[i];
    angles_deg[i] = angle_deg(X_SW.linear() * Eigen::Vector3d(p.nx, p.ny, p.nz),
                              true_normal(scene, X_SW * position_W(p)));
  });
  error.median_m = percentile(errors_m, 0.5);
  error.percentile_95_m = percentile(errors_m, 0.95);
  error.percentile_99_m = percentile(errors_m, 0.99);
  error.max_m = percentile(errors_m, 1.0);
  error.median_normal_deg = percentile(angles_deg, 0.5);
  error.percentile_95_normal_deg = percentile(angles_deg, 0.95);
  error.points_per_m2 = points_per_m2(points_W);
  return error;
}

}  // namespace kintsugi::mapper

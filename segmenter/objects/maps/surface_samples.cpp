#include "segmenter/objects/maps/surface_samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace kintsugi::segmenter {
namespace {

// Cell, and the axis and sign of the largest part of the normal: both sides of a thin thing stay.
using Key = std::array<std::int32_t, 4>;

Key key_of(const CloudPoint& point, double cell_m) {
  const auto index = [&](float x) {
    return static_cast<std::int32_t>(std::floor(static_cast<double>(x) / cell_m));
  };
  Eigen::Index axis = 0;
  const Eigen::Vector3f normal = normal_of(point);
  (void)normal.cwiseAbs().maxCoeff(&axis);
  const auto side = static_cast<std::int32_t>(2 * axis + (normal[axis] < 0.0F ? 1 : 0));
  return {index(point.x), index(point.y), index(point.z), side};
}

struct Sum {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
  double num_points = 0.0;
  double num_colored = 0.0;

  void add(const CloudPoint& point) {
    position += position_of(point).cast<double>();
    normal += normal_of(point).cast<double>();
    num_points += 1.0;
    if (!has_color(point)) return;
    color += Eigen::Vector3d(point.red, point.green, point.blue);
    num_colored += 1.0;
  }

  [[nodiscard]] CloudPoint mean() const {
    const Eigen::Vector3f p = (position / num_points).cast<float>();
    const Eigen::Vector3f n = normal.normalized().cast<float>();
    CloudPoint point{p.x(), p.y(), p.z(), n.x(), n.y(), n.z()};
    point.weight = static_cast<float>(num_points);
    if (num_colored == 0.0) return point;
    const auto level = [&](Eigen::Index channel) {
      return static_cast<std::uint8_t>(std::lround(color[channel] / num_colored));
    };
    point.red = level(0);
    point.green = level(1);
    point.blue = level(2);
    return point;
  }
};

}  // namespace

std::vector<CloudPoint> surface_samples(std::span<const CloudPoint> points, double cell_m) {
  std::vector<std::pair<Key, std::uint32_t>> by_cell;
  by_cell.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    by_cell.emplace_back(key_of(points[i], cell_m), static_cast<std::uint32_t>(i));
  }
  std::ranges::sort(by_cell, [&](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    const CloudPoint& p = points[a.second];
    const CloudPoint& q = points[b.second];
    return std::array{p.x, p.y, p.z} < std::array{q.x, q.y, q.z};
  });
  std::vector<CloudPoint> samples;
  for (std::size_t i = 0; i < by_cell.size();) {
    Sum sum;
    const std::size_t begin = i;
    for (; i < by_cell.size() && by_cell[i].first == by_cell[begin].first; ++i) {
      sum.add(points[by_cell[i].second]);
    }
    if (sum.normal.norm() > 0.5 * sum.num_points) samples.push_back(sum.mean());
  }
  return samples;
}

}  // namespace kintsugi::segmenter

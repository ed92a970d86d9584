#include "segmenter/preprocess/normal_sharpening.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace kintsugi::segmenter {
namespace {

/// Thickness relative to width. Below a thousandth all planes are equally good: what is left is
/// rounding.
float relative_thickness(const LocalPlane& plane) {
  constexpr float kMinThickness = 1e-3F;
  return std::max(plane.thickness_m / plane.width_m, kMinThickness);
}

bool lies_on(const CloudPoint& p, const LocalPlane& plane, const CloudPoint& normal) {
  constexpr float kMaxDeviations = 3.0F;
  constexpr float kMinTolerance = 0.05F;  // of the width, for planes without noise
  const Eigen::Vector3f from_mean = Eigen::Vector3f(p.x, p.y, p.z) - plane.mean_W;
  const float distance = std::abs(from_mean.dot(Eigen::Vector3f(normal.nx, normal.ny, normal.nz)));
  return distance <= std::max(kMaxDeviations * plane.thickness_m, kMinTolerance * plane.width_m);
}

}  // namespace

void sharpen_normals(std::span<CloudPoint> points_W, std::span<const LocalPlane> planes,
                     const NeighbourGraph& graph, int num_rounds) {
  constexpr float kMuchBetter = 0.5F;
  std::vector<std::uint32_t> chosen(points_W.size());  // the point whose plane each has taken
  std::iota(chosen.begin(), chosen.end(), 0U);
  std::vector<std::uint32_t> next = chosen;
  const auto choose = [&](std::size_t i) {
    if (planes[i].width_m <= 0.0F) return;
    float best = kMuchBetter * relative_thickness(planes[i]);
    if (chosen[i] != i) best = relative_thickness(planes[chosen[i]]);
    for (const std::uint32_t j : graph.neighbours_of(i)) {
      const std::uint32_t candidate = chosen[j];
      const LocalPlane& plane = planes[candidate];
      if (plane.width_m <= 0.0F) continue;
      const float thickness = relative_thickness(plane);
      if (thickness < best && lies_on(points_W[i], plane, points_W[candidate])) {
        best = thickness;
        next[i] = candidate;
      }
    }
  };
  for (int round = 0; round < num_rounds; ++round) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points_W.size()), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) choose(i);
    });
    chosen = next;
  }
  std::vector<CloudPoint> sharp_W(points_W.begin(), points_W.end());
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    const CloudPoint& from = points_W[chosen[i]];
    sharp_W[i].nx = from.nx;
    sharp_W[i].ny = from.ny;
    sharp_W[i].nz = from.nz;
  }
  std::ranges::copy(sharp_W, points_W.begin());
}

}  // namespace kintsugi::segmenter

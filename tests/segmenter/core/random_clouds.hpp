#pragma once
// Random clouds for the tests of the segmenter's core: normals that vary smoothly give joins, ties
// give equal weights, lattices give equal distances.

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter::testing {

inline CloudPoint make_point(double x, double y, double z, double nx, double ny, double nz) {
  const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
  CloudPoint p;
  p.x = static_cast<float>(x);
  p.y = static_cast<float>(y);
  p.z = static_cast<float>(z);
  p.nx = static_cast<float>(nx / length);
  p.ny = static_cast<float>(ny / length);
  p.nz = static_cast<float>(nz / length);
  return p;
}

/// `p` in the colour of `other`.
inline CloudPoint colored_as(const CloudPoint& other, CloudPoint p) {
  p.red = other.red;
  p.green = other.green;
  p.blue = other.blue;
  return p;
}

/// Each point in one of three colours or in none, by chance.
inline void paint_at_random(std::vector<CloudPoint>& points, unsigned seed) {
  constexpr int kNumColors = 4;
  constexpr std::uint8_t kPalette[kNumColors][3] = {
      {0, 0, 0}, {120, 90, 60}, {124, 93, 66}, {200, 20, 10}};
  std::mt19937 generator(seed);
  for (CloudPoint& p : points) {
    const auto& color = kPalette[generator() % kNumColors];
    p.red = color[0];
    p.green = color[1];
    p.blue = color[2];
  }
}

enum class CloudShape {
  kWaves,      ///< a wavy sheet with noise: segments of many sizes
  kLattice,    ///< a lattice whose normals take few values: many equal weights and distances
  kUnrelated,  ///< uniform in a box, hashed normals
};

/// `num_points` points spaced as in a map with voxels of `resolution_m`.
inline std::vector<CloudPoint> random_cloud(CloudShape shape, int num_points, unsigned seed,
                                            double resolution_m = 0.01) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> normal;
  const double extent_m = resolution_m * std::sqrt(static_cast<double>(num_points));
  std::vector<CloudPoint> points;
  for (int k = 0; k < num_points; ++k) {
    const double x = unit(generator) * extent_m;
    const double y = unit(generator) * extent_m;
    switch (shape) {
      case CloudShape::kWaves: {
        const double k_x = 30.0 + seed % 7;
        const double slope_x = 0.4 * std::cos(k_x * x);
        const double slope_y = 0.3 * std::sin(25.0 * y);
        points.push_back(make_point(
            x, y, 0.4 / k_x * std::sin(k_x * x) - 0.012 * std::cos(25.0 * y),
            -slope_x + 0.01 * normal(generator), -slope_y + 0.01 * normal(generator), 1.0));
        break;
      }
      case CloudShape::kLattice: {
        const double step_m = 0.75 * resolution_m;
        const double tilt = 0.02 * static_cast<double>(generator() % 4);
        points.push_back(make_point(std::round(x / step_m) * step_m,
                                    std::round(y / step_m) * step_m, 0.0, tilt, 0.0, 1.0));
        break;
      }
      case CloudShape::kUnrelated:
        points.push_back(make_point(x, y, unit(generator) * 2.0 * resolution_m,
                                    0.06 * normal(generator), 0.06 * normal(generator), 1.0));
        break;
    }
  }
  return points;
}

}  // namespace kintsugi::segmenter::testing

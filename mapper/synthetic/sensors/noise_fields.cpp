#include "mapper/synthetic/sensors/noise_fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <tbb/parallel_for.h>

#include "mapper/synthetic/scene/counter_random.hpp"
#include "mapper/synthetic/sensors/standard_normal.hpp"

namespace kintsugi::synthetic {

namespace {

float smooth_step(float x) { return x * x * (3.0F - 2.0F * x); }

std::uint32_t hash_node(std::uint32_t seed, int x, int y, int z) {
  return hash32(seed, static_cast<std::uint32_t>(x) * 0x8da6b343U +
                          static_cast<std::uint32_t>(y) * 0xd8163841U +
                          static_cast<std::uint32_t>(z) * 0xcb1ab31fU);
}

}  // namespace

cv::Mat_<float> windowed_noise(cv::Size size, int window_px, std::uint32_t seed) {
  constexpr float kUnits = 4096.0F;  // of the integers that stand for the noise, in 1
  const int padded_width = size.width + window_px - 1;
  const int padded_height = size.height + window_px - 1;
  cv::Mat_<std::int32_t> row_sums(padded_height, size.width);
  tbb::parallel_for(0, padded_height, [&](int v) {
    std::vector<std::int32_t> noise(static_cast<std::size_t>(padded_width));
    for (int u = 0; u < padded_width; ++u) {
      const auto pixel = hash32(seed, static_cast<std::uint32_t>(v * padded_width + u));
      noise[u] = static_cast<std::int32_t>(std::lround(kUnits * standard_normal(pixel)));
    }
    std::int32_t sum = 0;
    for (int u = 0; u < window_px - 1; ++u) sum += noise[u];
    for (int u = 0; u < size.width; ++u) {
      sum += noise[u + window_px - 1];
      row_sums(v, u) = sum;
      sum -= noise[u];
    }
  });
  const float scale = 1.0F / (kUnits * static_cast<float>(window_px));
  cv::Mat_<float> averaged(size);
  tbb::parallel_for(0, size.height, [&](int v) {
    for (int u = 0; u < size.width; ++u) {
      std::int32_t sum = 0;
      for (int i = 0; i < window_px; ++i) sum += row_sums(v + i, u);
      averaged(v, u) = scale * static_cast<float>(sum);
    }
  });
  return averaged;
}

double GridNoise::at(double v, double u) const {
  const auto y = static_cast<float>(v / cell_px_);
  const auto x = static_cast<float>(u / cell_px_);
  const int iy = static_cast<int>(std::floor(y));
  const int ix = static_cast<int>(std::floor(x));
  const float sy = smooth_step(y - static_cast<float>(iy));
  const float sx = smooth_step(x - static_cast<float>(ix));
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (int dy : {0, 1}) {
    for (int dx : {0, 1}) {
      const double weight = (dy == 0 ? 1.0F - sy : sy) * (dx == 0 ? 1.0F - sx : sx);
      sum += weight * standard_normal(hash_node(seed_, ix + dx, iy + dy, 0));
      sum_of_squares += weight * weight;
    }
  }
  return sum / std::sqrt(sum_of_squares);
}

Patches::Patches(double size_m, double share, std::uint32_t seed)
    : cells_per_m_(static_cast<float>(1.0 / size_m)), seed_(seed) {
  if (share <= 0.0) {
    threshold_ = std::numeric_limits<float>::infinity();
    return;
  }
  constexpr int kSamples = 20'000;  // the share is met to 0.3 % (one standard deviation)
  CounterRandom random(seed);
  std::vector<float> values(kSamples);
  for (float& value_there : values) {
    const double extent_m = 1000.0 * size_m;
    const Eigen::Vector3d p_W(random.uniform(0, extent_m), random.uniform(0, extent_m),
                              random.uniform(0, extent_m));
    value_there = value(p_W.cast<float>());
  }
  const auto quantile =
      values.begin() + static_cast<std::ptrdiff_t>((1.0 - share) * (kSamples - 1));
  std::nth_element(values.begin(), quantile, values.end());
  threshold_ = *quantile;
}

float Patches::value(const Eigen::Vector3f& p_W) const {
  const Eigen::Vector3f p = cells_per_m_ * p_W;
  const Eigen::Vector3f cell = p.array().floor();
  const Eigen::Vector3i i = cell.cast<int>();
  const Eigen::Vector3f s = (p - cell).unaryExpr(&smooth_step);
  std::array<float, 4> along_x{};
  for (int edge = 0; edge < 4; ++edge) {
    const int y = i.y() + (edge & 1);
    const int z = i.z() + (edge >> 1);
    along_x[edge] = std::lerp(unit_float(hash_node(seed_, i.x(), y, z)),
                              unit_float(hash_node(seed_, i.x() + 1, y, z)), s.x());
  }
  return std::lerp(std::lerp(along_x[0], along_x[1], s.y()),
                   std::lerp(along_x[2], along_x[3], s.y()), s.z());
}

}  // namespace kintsugi::synthetic

#include "mapper/synthetic/render/sensor_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/synthetic/scene/counter_random.hpp"

namespace kintsugi::synthetic {

namespace {

/// The standard normal distribution by its quantiles, in the middles of 4,096 equal shares: a draw
/// is a look-up. Their variance is 0.9995; the largest is 3.7.
class NormalTable {
 public:
  NormalTable() {
    double x = 0.0;
    for (int i = kHalf; i < kSize; ++i) {  // Newton's iteration, from the quantile before
      const double share = (i + 0.5) / kSize;
      for (int step = 0; step < 6; ++step) {
        const double above = 0.5 * std::erfc(x / std::numbers::sqrt2);
        const double density =
            std::exp(-0.5 * x * x) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
        x += (above - (1.0 - share)) / density;
      }
      quantiles_[i] = static_cast<float>(x);
      quantiles_[kSize - 1 - i] = -quantiles_[i];
    }
  }

  float draw(std::uint32_t hash) const { return quantiles_[hash % kSize]; }

 private:
  static constexpr int kSize = 4096;
  static constexpr int kHalf = kSize / 2;
  std::array<float, kSize> quantiles_{};
};

/// Whether a neighbour (of four) is at another depth, by more than the share `ratio`, or invalid.
bool at_depth_edge(const cv::Mat_<float>& depth_m, int v, int u, double ratio) {
  const float z = depth_m(v, u);
  const auto differs = [&](int nv, int nu) {
    if (nv < 0 || nu < 0 || nv >= depth_m.rows || nu >= depth_m.cols) return false;
    return !(std::abs(depth_m(nv, nu) - z) <= ratio * z);
  };
  return differs(v, u - 1) || differs(v, u + 1) || differs(v - 1, u) || differs(v + 1, u);
}

}  // namespace

void SensorModel::Config::validate() const {
  require(min_depth_m > 0, "min_depth_m", min_depth_m, "a value above 0");
  require(max_depth_m > min_depth_m && max_depth_m <= 65, "max_depth_m", max_depth_m,
          "a value above min_depth_m and at most 65");
  require(sigma_base_m >= 0, "sigma_base_m", sigma_base_m, "at least 0");
  require(sigma_square_per_m >= 0, "sigma_square_per_m", sigma_square_per_m, "at least 0");
  require(std::isfinite(sigma_offset_m), "sigma_offset_m", sigma_offset_m, "a finite value");
  require(baseline_m > 0, "baseline_m", baseline_m, "a value above 0");
  require(disparity_step_px >= 0, "disparity_step_px", disparity_step_px, "at least 0");
  require(max_incidence_rad > 0 && max_incidence_rad <= std::numbers::pi / 2, "max_incidence_rad",
          max_incidence_rad, "a value in (0, pi / 2]");
  require(edge_step_ratio > 0, "edge_step_ratio", edge_step_ratio, "a value above 0");
  require(edge_loss_probability >= 0 && edge_loss_probability <= 1, "edge_loss_probability",
          edge_loss_probability, "a value in [0, 1]");
}

SensorModel::SensorModel(const Config& config) : config_(config) { config_.validate(); }

double SensorModel::sigma_m(double z_m) const {
  const double beyond_m = z_m - config_.sigma_offset_m;
  return config_.sigma_base_m + config_.sigma_square_per_m * beyond_m * beyond_m;
}

cv::Mat_<std::uint16_t> SensorModel::apply(const RenderedFrame& frame,
                                           std::int64_t frame_index) const {
  static const NormalTable normal;
  const Intrinsics& camera = frame.intrinsics;
  cv::Mat_<std::uint16_t> depth_mm(frame.depth_m.size());
  const auto frame_seed = hash32(config_.seed, static_cast<std::uint32_t>(frame_index));
  const double min_cosine = std::cos(config_.max_incidence_rad);
  const Eigen::Matrix3d R_CW = frame.X_WC.linear().transpose();

  const auto measure = [&](int v, int u) -> double {  // metres; NaN or out of range: lost
    const double z = frame.depth_m(v, u);
    if (!config_.noise || std::isnan(z)) return z;
    const auto pixel = hash32(frame_seed, static_cast<std::uint32_t>(v * camera.width + u));
    if (at_depth_edge(frame.depth_m, v, u, config_.edge_step_ratio) &&
        unit_float(hash32(pixel, 1)) < config_.edge_loss_probability) {
      return 0.0;
    }
    const cv::Vec3f n = frame.normals_W(v, u);
    const Eigen::Vector3d ray_C((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
    const double facing = -(R_CW * Eigen::Vector3d(n[0], n[1], n[2])).dot(ray_C);  // cosine |ray|
    if (facing < 0.0 || facing * facing < min_cosine * min_cosine * ray_C.squaredNorm()) return 0.0;
    const double noisy = z + sigma_m(z) * normal.draw(pixel);
    if (config_.disparity_step_px <= 0.0 || noisy <= 0.0) return noisy;
    const double scale = config_.baseline_m * camera.fx / config_.disparity_step_px;
    return scale / std::max(1.0, std::floor(scale / noisy + 0.5));
  };

  tbb::parallel_for(0, depth_mm.rows, [&](int v) {
    for (int u = 0; u < depth_mm.cols; ++u) {
      const double z = measure(v, u);
      const bool seen = z >= config_.min_depth_m && z <= config_.max_depth_m;
      depth_mm(v, u) = seen ? static_cast<std::uint16_t>(std::lround(1000.0 * z)) : 0;
    }
  });
  return depth_mm;
}

}  // namespace kintsugi::synthetic

#include "mapper/synthetic/sensors/structured_light.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <tbb/parallel_for.h>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/synthetic/scene/counter_random.hpp"
#include "mapper/synthetic/sensors/standard_normal.hpp"
#include "mapper/synthetic/sensors/surface_view.hpp"

namespace kintsugi::synthetic {

void StructuredLight::Config::validate() const {
  synthetic::validate(range);
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

StructuredLight::StructuredLight(const Config& config) : config_(config) { config_.validate(); }

double StructuredLight::sigma_m(double z_m) const {
  const double beyond_m = z_m - config_.sigma_offset_m;
  return config_.sigma_base_m + config_.sigma_square_per_m * beyond_m * beyond_m;
}

cv::Mat_<double> StructuredLight::measure(const RenderedFrame& frame,
                                          std::int64_t frame_index) const {
  constexpr double kLost = std::numeric_limits<double>::quiet_NaN();
  const Intrinsics& camera = frame.intrinsics;
  const auto frame_seed = hash32(config_.seed, static_cast<std::uint32_t>(frame_index));
  const double min_cosine = std::cos(config_.max_incidence_rad);
  const IncidenceAngles incidence(frame);

  const auto measure_pixel = [&](int v, int u) -> double {
    const double z = frame.depth_m(v, u);
    if (std::isnan(z)) return kLost;
    const auto pixel = hash32(frame_seed, static_cast<std::uint32_t>(v * camera.width + u));
    if (at_depth_edge(frame.depth_m, v, u, config_.edge_step_ratio) &&
        unit_float(hash32(pixel, 1)) < config_.edge_loss_probability) {
      return kLost;
    }
    if (incidence.cosine(v, u) < min_cosine) return kLost;
    const double noisy = z + sigma_m(z) * standard_normal(pixel);
    if (config_.disparity_step_px <= 0.0 || noisy <= 0.0) return noisy;
    const double scale = config_.baseline_m * camera.fx / config_.disparity_step_px;
    return scale / std::max(1.0, std::floor(scale / noisy + 0.5));
  };

  cv::Mat_<double> measured_m(frame.depth_m.size());
  tbb::parallel_for(0, measured_m.rows, [&](int v) {
    for (int u = 0; u < measured_m.cols; ++u) measured_m(v, u) = measure_pixel(v, u);
  });
  return measured_m;
}

}  // namespace kintsugi::synthetic

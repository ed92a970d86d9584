#include "mapper/synthetic/sensors/time_of_flight.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <tbb/parallel_for.h>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/synthetic/scene/counter_random.hpp"
#include "mapper/synthetic/sensors/standard_normal.hpp"
#include "mapper/synthetic/sensors/surface_view.hpp"

namespace kintsugi::synthetic {

void TimeOfFlight::Config::validate() const {
  synthetic::validate(range);
  require(max_incidence_rad > 0 && max_incidence_rad < std::numbers::pi / 2, "max_incidence_rad",
          max_incidence_rad, "a value in (0, pi / 2)");
  require(edge_step_ratio > 0, "edge_step_ratio", edge_step_ratio, "a value above 0");
  require(flying_probability >= 0 && flying_probability <= 1, "flying_probability",
          flying_probability, "a value in [0, 1]");
}

TimeOfFlight::TimeOfFlight(const Config& config) : config_(config) { config_.validate(); }

double TimeOfFlight::sigma_m(double z_m, double incidence_rad) {
  const double steepness = incidence_rad / (std::numbers::pi / 2 - incidence_rad);
  return 1e-3 *
         (1.5 - 0.5 * z_m + 0.3 * z_m * z_m + 0.1 * z_m * std::sqrt(z_m) * steepness * steepness);
}

cv::Mat_<double> TimeOfFlight::measure(const RenderedFrame& frame, std::int64_t frame_index) const {
  constexpr double kLost = std::numeric_limits<double>::quiet_NaN();
  const auto frame_seed = hash32(config_.seed, static_cast<std::uint32_t>(frame_index));
  const double min_cosine = std::cos(config_.max_incidence_rad);
  const IncidenceAngles incidence(frame);

  const auto measure_pixel = [&](int v, int u) -> double {
    const double z = frame.depth_m(v, u);
    if (std::isnan(z)) return kLost;
    const double cosine = incidence.cosine(v, u);
    if (cosine < min_cosine) return kLost;
    const auto pixel = hash32(frame_seed, static_cast<std::uint32_t>(v * frame.depth_m.cols + u));
    double seen_m = z;
    if (unit_float(hash32(pixel, 1)) < config_.flying_probability) {
      const double share = unit_float(hash32(pixel, 2));
      const auto other_m = depth_across_edge(frame.depth_m, v, u, config_.edge_step_ratio);
      if (other_m) seen_m += share * (*other_m - z);
    }
    const double angle_rad = std::acos(std::min(1.0, cosine));
    return seen_m + sigma_m(z, angle_rad) * standard_normal(pixel);
  };

  cv::Mat_<double> measured_m(frame.depth_m.size());
  tbb::parallel_for(0, measured_m.rows, [&](int v) {
    for (int u = 0; u < measured_m.cols; ++u) measured_m(v, u) = measure_pixel(v, u);
  });
  return measured_m;
}

}  // namespace kintsugi::synthetic

#include "mapper/synthetic/sensors/phone_lidar.hpp"

#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/synthetic/scene/counter_random.hpp"
#include "mapper/synthetic/sensors/noise_fields.hpp"

namespace kintsugi::synthetic {

namespace {

/// Mean of the valid values within half a width of each pixel, along rows and then along columns
/// with the weights of a triangle: what averaging twice over `width` gives.
cv::Mat_<double> averaged_twice(const cv::Mat_<double>& values, int width, cv::Point step) {
  const int reach = width - 1;
  cv::Mat_<double> averaged(values.size());
  tbb::parallel_for(0, values.rows, [&](int v) {
    for (int u = 0; u < values.cols; ++u) {
      double sum = 0.0;
      double weights = 0.0;
      for (int i = -reach; i <= reach; ++i) {
        const int nv = v + i * step.y;
        const int nu = u + i * step.x;
        if (nv < 0 || nu < 0 || nv >= values.rows || nu >= values.cols) continue;
        if (std::isnan(values(nv, nu))) continue;
        const double weight = width - std::abs(i);
        sum += weight * values(nv, nu);
        weights += weight;
      }
      averaged(v, u) = sum / weights;  // NaN where nothing is valid
    }
  });
  return averaged;
}

}  // namespace

void PhoneLidar::Config::validate() const {
  synthetic::validate(range);
  require(relative_sigma >= 0, "relative_sigma", relative_sigma, "at least 0");
  require(constant_share >= 0 && constant_share <= 1, "constant_share", constant_share,
          "a value in [0, 1]");
  require(cell_px > 0, "cell_px", cell_px, "a value above 0");
  require(change_frames >= 1, "change_frames", change_frames, "at least 1");
  require(blur_px >= 1 && blur_px % 2 == 1, "blur_px", blur_px, "odd and at least 1");
}

PhoneLidar::PhoneLidar(const Config& config) : config_(config) { config_.validate(); }

cv::Mat_<double> PhoneLidar::measure(const RenderedFrame& frame, std::int64_t frame_index) const {
  cv::Mat_<double> inverse_depth(frame.depth_m.size());
  cv::divide(1.0, cv::Mat_<double>(frame.depth_m), inverse_depth);
  inverse_depth = averaged_twice(inverse_depth, config_.blur_px, {1, 0});
  inverse_depth = averaged_twice(inverse_depth, config_.blur_px, {0, 1});

  const auto period = static_cast<std::uint32_t>(frame_index / config_.change_frames);
  const double share =
      static_cast<double>(frame_index % config_.change_frames) / config_.change_frames;
  const auto seed_of = [&](std::uint32_t p) { return hash32(hash32(config_.seed, 2), p); };
  const GridNoise constant(config_.cell_px, hash32(config_.seed, 1));
  const GridNoise fading(config_.cell_px, seed_of(period));
  const GridNoise rising(config_.cell_px, seed_of(period + 1));
  const double changing_share = 1.0 - config_.constant_share;
  const double scale = std::sqrt(changing_share / (share * share + (1 - share) * (1 - share)));

  cv::Mat_<double> measured_m(frame.depth_m.size());
  tbb::parallel_for(0, measured_m.rows, [&](int v) {
    for (int u = 0; u < measured_m.cols; ++u) {
      const double error = std::sqrt(config_.constant_share) * constant.at(v, u) +
                           scale * ((1 - share) * fading.at(v, u) + share * rising.at(v, u));
      const bool is_sky = std::isnan(frame.depth_m(v, u));
      measured_m(v, u) = is_sky ? std::numeric_limits<double>::quiet_NaN()
                                : (1.0 + config_.relative_sigma * error) / inverse_depth(v, u);
    }
  });
  return measured_m;
}

}  // namespace kintsugi::synthetic

#include "mapper/synthetic/sensors/stereo.hpp"

#include <cmath>
#include <limits>

#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/synthetic/scene/counter_random.hpp"
#include "mapper/synthetic/sensors/standard_normal.hpp"
#include "mapper/synthetic/sensors/surface_view.hpp"

namespace kintsugi::synthetic {

namespace {

using Mask = cv::Mat_<std::uint8_t>;

/// Pixels of the left image that the right one does not show, because it ends there or because
/// something nearer is in front.
Mask hidden_from_right(const cv::Mat_<float>& depth_m, double disparity_times_m) {
  Mask hidden(depth_m.size());
  tbb::parallel_for(0, depth_m.rows, [&](int v) {
    double leftmost = std::numeric_limits<double>::infinity();  // in the right image, so far
    for (int u = depth_m.cols - 1; u >= 0; --u) {
      const double z = depth_m(v, u);
      const double in_right = std::isnan(z) ? u : u - disparity_times_m / z;
      hidden(v, u) = in_right < 0.0 || in_right >= leftmost ? 1 : 0;
      leftmost = std::min(leftmost, in_right);
    }
  });
  return hidden;
}

/// Pixels whose window contains a depth edge.
Mask near_depth_edge(const cv::Mat_<float>& depth_m, double ratio, int window_px) {
  Mask edges(depth_m.size());
  tbb::parallel_for(0, depth_m.rows, [&](int v) {
    for (int u = 0; u < depth_m.cols; ++u) {
      edges(v, u) = at_depth_edge(depth_m, v, u, ratio) ? 1 : 0;
    }
  });
  Mask near;
  cv::dilate(edges, near, Mask(window_px, window_px, std::uint8_t{1}), cv::Point(-1, -1), 1,
             cv::BORDER_CONSTANT, cv::Scalar(0));
  return near;
}

const Stereo::Config& validated(const Stereo::Config& config) {
  config.validate();
  return config;
}

}  // namespace

void Stereo::Config::validate() const {
  synthetic::validate(range);
  require(baseline_m > 0, "baseline_m", baseline_m, "a value above 0");
  require(sigma_disparity_px >= 0, "sigma_disparity_px", sigma_disparity_px, "at least 0");
  require(disparity_step_px >= 0, "disparity_step_px", disparity_step_px, "at least 0");
  require(window_px >= 1 && window_px % 2 == 1, "window_px", window_px, "odd and at least 1");
  require(edge_step_ratio > 0, "edge_step_ratio", edge_step_ratio, "a value above 0");
  require(edge_loss_probability >= 0 && edge_loss_probability <= 1, "edge_loss_probability",
          edge_loss_probability, "a value in [0, 1]");
  require(untextured_share >= 0 && untextured_share <= 1, "untextured_share", untextured_share,
          "a value in [0, 1]");
  require(untextured_size_m > 0, "untextured_size_m", untextured_size_m, "a value above 0");
}

Stereo::Stereo(const Config& config)
    : config_(validated(config)),
      untextured_(config.untextured_size_m, config.untextured_share, config.seed) {}

double Stereo::quantised(double disparity_px) const {
  const double step = config_.disparity_step_px;
  return step > 0.0 ? step * std::floor(disparity_px / step + 0.5) : disparity_px;
}

cv::Mat_<double> Stereo::measure(const RenderedFrame& frame, std::int64_t frame_index) const {
  // How far the border of an untextured patch moves from frame to frame, in what
  // Patches::depth_within() gives.
  constexpr float kRaggedness = 0.02F;
  constexpr double kLost = std::numeric_limits<double>::quiet_NaN();
  const Intrinsics& camera = frame.intrinsics;
  const double disparity_times_m = camera.fx * config_.baseline_m;
  const auto frame_seed = hash32(config_.seed, static_cast<std::uint32_t>(frame_index));
  const Mask hidden = hidden_from_right(frame.depth_m, disparity_times_m);
  const Mask near_edge = near_depth_edge(frame.depth_m, config_.edge_step_ratio, config_.window_px);
  const cv::Mat_<float> error =
      windowed_noise(frame.depth_m.size(), config_.window_px, hash32(frame_seed, 3));
  const Eigen::Isometry3f X_WC = frame.X_WC.cast<float>();

  const auto measure_pixel = [&](int v, int u) -> double {
    const double z = frame.depth_m(v, u);
    if (std::isnan(z) || hidden(v, u) != 0) return kLost;
    const auto pixel = hash32(frame_seed, static_cast<std::uint32_t>(v * camera.width + u));
    if (near_edge(v, u) != 0 && unit_float(hash32(pixel, 1)) < config_.edge_loss_probability) {
      return kLost;
    }
    const Eigen::Vector3d p_C(z * (u - camera.cx) / camera.fx, z * (v - camera.cy) / camera.fy, z);
    const float within = untextured_.depth_within(X_WC * p_C.cast<float>());
    if (within > kRaggedness * standard_normal(hash32(pixel, 2))) return kLost;
    const double disparity_px = disparity_times_m / z + config_.sigma_disparity_px * error(v, u);
    return disparity_times_m / quantised(disparity_px);
  };

  cv::Mat_<double> measured_m(frame.depth_m.size());
  tbb::parallel_for(0, measured_m.rows, [&](int v) {
    for (int u = 0; u < measured_m.cols; ++u) measured_m(v, u) = measure_pixel(v, u);
  });
  return measured_m;
}

}  // namespace kintsugi::synthetic

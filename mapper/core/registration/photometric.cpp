#include "mapper/core/registration/photometric.hpp"

#include <algorithm>
#include <cmath>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/frame/camera.hpp"

namespace kintsugi::mapper {
namespace {

/// Sums of a band of rows.
struct PhotometricSum {
  InformationSum motion;
  Vector6f rows = Vector6f::Zero();       ///< weighted: couples the motion to the bias
  Vector6f residuals = Vector6f::Zero();  ///< weighted rows times residual
  double weight = 0.0;
  double residual = 0.0;  ///< weighted
  double squares = 0.0;   ///< of residuals; not weighted, like the moments
  double moments_C[2] = {};
  double moments_K[2] = {};
  std::int64_t pixels = 0;
};

/// Interpolated value and gradient of an image.
struct Intensity {
  float value = 0.0F;
  Eigen::Vector2f gradient = Eigen::Vector2f::Zero();
};

/// x and y at least one pixel inside the image.
Intensity interpolate(const IntensityMap& map, float x, float y) {
  const int u = static_cast<int>(x);
  const int v = static_cast<int>(y);
  const float right = x - static_cast<float>(u);
  const float below = y - static_cast<float>(v);
  const auto mix = [&](const cv::Mat_<float>& image) {
    const float* upper = image.ptr<float>(v) + u;
    const float* lower = image.ptr<float>(v + 1) + u;
    return (1.0F - below) * ((1.0F - right) * upper[0] + right * upper[1]) +
           below * ((1.0F - right) * lower[0] + right * lower[1]);
  };
  return {mix(map.value), {mix(map.gradient_u), mix(map.gradient_v)}};
}

class PixelPairs {
 public:
  PixelPairs(const PhotometricImage& frame_C, const PhotometricImage& reference_K, const Pose& X_VC,
             const Pose& X_KV, const std::optional<Exposure>& exposure,
             const PhotometricConfig& config)
      : frame_(frame_C),
        reference_(reference_K),
        camera_C_(pinhole_camera(frame_C.surface.intrinsics)),
        camera_K_(pinhole_camera(reference_K.surface.intrinsics)),
        X_VC_(X_VC.cast<float>()),
        X_KV_(X_KV.cast<float>()),
        is_first_(!exposure),
        gain_(static_cast<float>(exposure.value_or(Exposure()).gain)),
        bias_(static_cast<float>(exposure.value_or(Exposure()).bias)),
        config_(config) {}

  PhotometricSum sum_rows(int first, int last) const {
    PhotometricSum sum;
    for (int v = first; v < last; ++v) {
      for (int u = 0; u < frame_.surface.depth_m.cols; ++u) add_pixel(v, u, sum);
    }
    return sum;
  }

 private:
  /// Derivative of an image's intensity with respect to the point that it shows.
  static Eigen::Vector3f by_point(const PinholeCamera& camera, const Eigen::Vector2f& gradient,
                                  const Eigen::Vector3f& point) {
    const float du = gradient.x() * camera.fx / point.z();
    const float dv = gradient.y() * camera.fy / point.z();
    return {du, dv, -(du * point.x() + dv * point.y()) / point.z()};
  }

  /// The pixel of the reference onto which a point in K projects, if it is visible there.
  std::optional<Eigen::Vector2f> seen_at(const Eigen::Vector3f& point_K) const {
    if (!(point_K.z() > 0.0F)) return std::nullopt;
    const cv::Mat_<float>& depth_m = reference_.surface.depth_m;
    const float x = camera_K_.fx * point_K.x() / point_K.z() + camera_K_.cx;
    const float y = camera_K_.fy * point_K.y() / point_K.z() + camera_K_.cy;
    if (!(x >= 1.0F && y >= 1.0F)) return std::nullopt;
    if (!(x < depth_m.cols - 2.0F && y < depth_m.rows - 2.0F)) return std::nullopt;
    const float seen_m =
        depth_m(static_cast<int>(std::lround(y)), static_cast<int>(std::lround(x)));
    const double allowed_m = std::max(
        config_.min_depth_step_m, config_.depth_sigmas * frame_.surface.noise.sigma_m(point_K.z()));
    if (!(std::abs(seen_m - point_K.z()) < allowed_m)) return std::nullopt;  // false for a NaN
    return Eigen::Vector2f(x, y);
  }

  float weight(float residual) const {
    const auto sigma = static_cast<float>(config_.sigma);
    const auto limit = static_cast<float>(config_.huber_sigmas * config_.sigma);
    const float full = 1.0F / (sigma * sigma);
    return is_first_ || std::abs(residual) <= limit ? full : full * limit / std::abs(residual);
  }

  void add_pixel(int v, int u, PhotometricSum& sum) const {
    const Eigen::Vector3f point_C = frame_.surface.point(v, u);
    if (std::isnan(point_C.z())) return;
    const Eigen::Vector3f point_V = X_VC_ * point_C;
    const Eigen::Vector3f point_K = X_KV_ * point_V;
    const auto pixel_K = seen_at(point_K);
    if (!pixel_K) return;

    const Intensity seen = interpolate(reference_.intensity, pixel_K->x(), pixel_K->y());
    const float intensity = frame_.intensity.value(v, u);
    const Eigen::Vector2f gradient(gain_ * frame_.intensity.gradient_u(v, u),
                                   gain_ * frame_.intensity.gradient_v(v, u));
    const Eigen::Vector3f by_point_K =
        X_KV_.linear().transpose() * by_point(camera_K_, seen.gradient, point_K);
    const Eigen::Vector3f by_point_C = X_VC_.linear() * by_point(camera_C_, gradient, point_C);

    const Vector6f row = increment_row(by_point_K, point_V);
    const float residual = seen.value - gain_ * intensity - bias_;
    const float w = weight(residual);
    sum.motion.add(row, increment_row(by_point_C, point_V), w);
    sum.rows += w * row;
    sum.residuals += (w * residual) * row;
    sum.weight += w;
    sum.residual += w * residual;
    sum.squares += residual * residual;
    sum.moments_C[0] += intensity;
    sum.moments_C[1] += intensity * intensity;
    sum.moments_K[0] += seen.value;
    sum.moments_K[1] += seen.value * seen.value;
    ++sum.pixels;
  }

  PhotometricImage frame_;
  PhotometricImage reference_;
  PinholeCamera camera_C_;
  PinholeCamera camera_K_;
  Eigen::Isometry3f X_VC_;
  Eigen::Isometry3f X_KV_;
  bool is_first_;  ///< no exposure is known yet
  float gain_;
  float bias_;
  PhotometricConfig config_;
};

/// The exposure that makes mean and standard deviation of both intensities equal.
Exposure exposure_of(const PhotometricSum& sum) {
  constexpr double kMinVariance = 1e-6;  // (a quarter of a grey level)^2: no texture below this
  const auto pixels = static_cast<double>(sum.pixels);
  const double mean_C = sum.moments_C[0] / pixels;
  const double mean_K = sum.moments_K[0] / pixels;
  const double variance_C = sum.moments_C[1] / pixels - mean_C * mean_C;
  const double variance_K = sum.moments_K[1] / pixels - mean_K * mean_K;
  Exposure exposure;
  if (std::min(variance_C, variance_K) > kMinVariance) {
    exposure.gain = std::sqrt(variance_K / variance_C);
  }
  exposure.bias = mean_K - exposure.gain * mean_C;
  return exposure;
}

}  // namespace

void PhotometricConfig::validate() const {
  check_range("photometric sigma", sigma, 1e-6, 1.0);
  check_range("huber_sigmas", huber_sigmas, 1e-3, 1e6);
  check_range("depth_sigmas", depth_sigmas, 0.0, 1e6);
  check_range("min_depth_step_m", min_depth_step_m, 0.0, 1e3);
}

PhotometricEquations linearize_photometric(const PhotometricImage& frame_C,
                                           const PhotometricImage& reference_K, const Pose& X_VC,
                                           const Pose& X_KV,
                                           const std::optional<Exposure>& exposure,
                                           const PhotometricConfig& config) {
  const PixelPairs pairs(frame_C, reference_K, X_VC, X_KV, exposure, config);
  PhotometricEquations equations;
  PhotometricSum total;
  Vector6d rows = Vector6d::Zero();
  for (const PhotometricSum& band : sum_bands<PhotometricSum>(
           frame_C.surface.depth_m.rows,
           [&](int first, int last) { return pairs.sum_rows(first, last); })) {
    band.motion.add_to(equations.information);
    rows += band.rows.cast<double>();
    equations.b -= band.residuals.cast<double>();
    total.weight += band.weight;
    total.residual += band.residual;
    total.squares += band.squares;
    for (int k = 0; k < 2; ++k) {
      total.moments_C[k] += band.moments_C[k];
      total.moments_K[k] += band.moments_K[k];
    }
    total.pixels += band.pixels;
  }
  if (total.pixels == 0) return equations;
  equations.mean_residual = total.residual / total.weight;
  const Matrix6d explained_by_bias = rows * rows.transpose() / total.weight;
  equations.information.A -= explained_by_bias;
  equations.information.C -= explained_by_bias;
  equations.b += rows * equations.mean_residual;
  equations.exposure = exposure_of(total);
  equations.rms = std::sqrt(total.squares / static_cast<double>(total.pixels));
  equations.pixels = total.pixels;
  return equations;
}

}  // namespace kintsugi::mapper

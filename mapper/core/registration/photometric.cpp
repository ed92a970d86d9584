#include "mapper/core/registration/photometric.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/frame/kernel_arguments.hpp"
#include "mapper/core/registration/row_bands.hpp"

namespace kintsugi::mapper {
namespace {

IntensityPlanes planes_of(const IntensityMap& map) {
  assert(map.value.isContinuous() && map.gradient_u.isContinuous() &&
         map.gradient_v.isContinuous());
  return {map.value[0], map.gradient_u[0], map.gradient_v[0]};
}

PhotometryInput make_input(const PhotometricImage& frame_C, const PhotometricImage& reference_K,
                           const Pose& X_VC, const Pose& X_KV,
                           const std::optional<Exposure>& exposure,
                           const PhotometricConfig& config) {
  const double limit = config.huber_sigmas * config.sigma;
  PhotometryInput input;
  input.surface_C = planes_of(frame_C.surface);
  input.surface_K = planes_of(reference_K.surface);
  input.intensity_C = planes_of(frame_C.intensity);
  input.intensity_K = planes_of(reference_K.intensity);
  input.X_VC = rigid_motion(X_VC);
  input.X_KV = rigid_motion(X_KV);
  input.gain = static_cast<float>(exposure.value_or(Exposure()).gain);
  input.bias = static_cast<float>(exposure.value_or(Exposure()).bias);
  input.weight = static_cast<float>(1.0 / (config.sigma * config.sigma));
  input.full_weight_up_to =
      exposure ? static_cast<float>(limit) : std::numeric_limits<float>::infinity();
  input.variance = depth_variance(frame_C.surface.noise);
  input.depth_sigmas = static_cast<float>(config.depth_sigmas);
  input.min_depth_step_m = static_cast<float>(config.min_depth_step_m);
  return input;
}

/// The sums over all bands, in double precision.
struct PhotometryTotal {
  Eigen::Matrix<double, 8, 8> products = Eigen::Matrix<double, 8, 8>::Zero();
  Matrix6d cross_products = Matrix6d::Zero();
  double squared_residuals = 0.0;
  double moments_C[2] = {};
  double moments_K[2] = {};
  std::int64_t pixels = 0;

  void add(const PhotometrySums& band) {
    add_triangle(band.products, products);
    add_triangle(band.cross_products, cross_products);
    squared_residuals += band.squared_residuals;
    for (int k = 0; k < 2; ++k) {
      moments_C[k] += band.moments_C[k];
      moments_K[k] += band.moments_K[k];
    }
    pixels += band.pixels;
  }

 private:
  /// Adds an upper triangle, row by row, to a symmetric matrix.
  template <typename Matrix>
  static void add_triangle(const float* triangle, Matrix& sum) {
    for (int i = 0, k = 0; i < sum.rows(); ++i) {
      for (int j = i; j < sum.cols(); ++j, ++k) sum(j, i) = sum(i, j) += triangle[k];
    }
  }
};

/// The exposure that makes mean and standard deviation of both intensities equal.
Exposure exposure_of(const PhotometryTotal& sum) {
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
                                           const PhotometricConfig& config,
                                           const Kernels& kernels) {
  const PhotometryInput input = make_input(frame_C, reference_K, X_VC, X_KV, exposure, config);
  PhotometryTotal total;
  for (const PhotometrySums& band : sum_bands<PhotometrySums>(
           frame_C.surface.depth_m.size(),
           [&](int first, int last) { return kernels.sum_photometry_rows(input, first, last); })) {
    total.add(band);
  }
  PhotometricEquations equations;
  if (total.pixels == 0) return equations;
  const Vector6d rows = total.products.col(7).head<6>();
  const double weight = total.products(7, 7);
  equations.mean_residual = total.products(6, 7) / weight;
  const Matrix6d explained_by_bias = rows * rows.transpose() / weight;
  equations.information.A = total.products.topLeftCorner<6, 6>() - explained_by_bias;
  equations.information.C = 0.5 * total.cross_products - explained_by_bias;
  equations.b = rows * equations.mean_residual - total.products.col(6).head<6>();
  equations.exposure = exposure_of(total);
  equations.rms = std::sqrt(total.squared_residuals / static_cast<double>(total.pixels));
  equations.pixels = total.pixels;
  return equations;
}

}  // namespace kintsugi::mapper

#include "mapper/core/tracking/noise_estimator.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "mapper/core/frame/camera.hpp"

namespace kintsugi::mapper {
namespace {

/// What a frame counts after each further one: 500 frames, 17 seconds, remain in effect.
constexpr double kDecay = 0.998;
/// The median of the amounts of normally distributed numbers, times this, is their deviation.
constexpr double kDeviationOfMedian = 1.4826;
/// Pairs whose points are farther apart, in deviations of the estimate so far, show different
/// surfaces. The estimate can still grow: half of the pairs that are left count less than it.
constexpr double kMaxSigmas = 6.0;
/// Steeper surfaces show the error across the image, not that of the depth.
constexpr float kMinCosine = 0.5F;
/// The start value counts like so many images at each depth.
constexpr double kImagesOfStart = 3.0;
/// Weight in the fit of a depth that was not seen, in images.
constexpr double kWeightOfStart = 0.1;

struct Deviation {
  double depth_m = 0.0;
  double sigma_m = 0.0;
  double weight = 0.0;
};

/// Squares of the coefficients of DepthNoise for which
///   sum_i w_i (sigma(z_i)^2 / s_i^2 - 1)^2
/// is smallest among those with none negative: the best of the solutions with some of them zero.
Eigen::Vector3d fit_squares(const std::vector<Deviation>& deviations) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Deviation& deviation : deviations) {
    const double z2 = deviation.depth_m * deviation.depth_m;
    const Eigen::Vector3d row =
        Eigen::Vector3d(1.0, z2, z2 * z2) / (deviation.sigma_m * deviation.sigma_m);
    A += deviation.weight * row * row.transpose();
    b += deviation.weight * row;
  }
  Eigen::Vector3d best = Eigen::Vector3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int used = 1; used < 8; ++used) {
    std::vector<int> terms;
    for (int i = 0; i < 3; ++i) {
      if ((used >> i & 1) != 0) terms.push_back(i);
    }
    const Eigen::MatrixXd reduced = A(terms, terms);
    const Eigen::VectorXd squares = reduced.ldlt().solve(b(terms));
    if (!squares.allFinite() || squares.minCoeff() < 0.0) continue;
    const double error = squares.dot(reduced * squares) - 2.0 * squares.dot(b(terms));
    if (error >= least) continue;
    least = error;
    best.setZero();
    best(terms) = squares;
  }
  return best;
}

}  // namespace

void NoiseEstimator::add(const SurfaceMap& frame_C, const SurfaceMap& model_V, const Pose& X_VC) {
  const PinholeCamera camera = pinhole_camera(model_V.intrinsics);
  const Eigen::Isometry3f X = X_VC.cast<float>();
  for (Histogram& histogram : counts_) {
    for (double& count : histogram) count *= kDecay;
  }
  for (int v = 0; v < frame_C.depth_m.rows; ++v) {
    for (int u = 0; u < frame_C.depth_m.cols; ++u) {
      const float depth_m = frame_C.depth_m(v, u);
      if (!(depth_m >= static_cast<float>(kNearest_m)) || std::isnan(frame_C.normal_z(v, u))) {
        continue;
      }
      const Eigen::Vector3f p = X * frame_C.point(v, u);
      const float x = camera.fx * p.x() / p.z() + camera.cx + 0.5F;
      const float y = camera.fy * p.y() / p.z() + camera.cy + 0.5F;
      if (!(p.z() > 0.0F && x >= 0.0F && y >= 0.0F)) continue;
      if (!(x < static_cast<float>(camera.width) && y < static_cast<float>(camera.height))) continue;
      const int col = static_cast<int>(x);
      const int row = static_cast<int>(y);
      const Eigen::Vector3f normal = model_V.normal(row, col);
      const float cosine = -normal.dot(p.normalized());
      if (!(cosine > kMinCosine)) continue;
      const float across_m = normal.dot(p - model_V.point(row, col));
      const float residual_m = std::abs(across_m / (cosine * p.norm())) * p.z();
      if (!(residual_m < kMaxSigmas * noise_.sigma_m(depth_m))) continue;
      const int depth_bin = static_cast<int>(std::log(depth_m / kNearest_m) / std::log(kDepthRatio));
      const int residual_bin = residual_m <= kSmallest_m
                                   ? 0
                                   : static_cast<int>(std::log(residual_m / kSmallest_m) /
                                                      std::log(kResidualRatio));
      counts_[std::min(depth_bin, kDepthBins - 1)][std::min(residual_bin, kResidualBins - 1)] += 1.0;
    }
  }
  noise_ = fit(static_cast<double>(frame_C.depth_m.total()));
}

double NoiseEstimator::depth_of_bin_m(int bin) {
  return kNearest_m * std::pow(kDepthRatio, bin + 0.5);
}

double NoiseEstimator::median_m(const Histogram& histogram, double total) {
  double below = 0.0;
  for (int bin = 0; bin < kResidualBins; ++bin) {
    const double next = below + histogram[bin];
    if (next >= 0.5 * total) {
      const double within = (0.5 * total - below) / histogram[bin];
      return kSmallest_m * std::pow(kResidualRatio, bin + within);
    }
    below = next;
  }
  return kSmallest_m * std::pow(kResidualRatio, kResidualBins);
}

DepthNoise NoiseEstimator::fit(double pixels_of_an_image) const {
  std::vector<Deviation> deviations;
  for (int bin = 0; bin < kDepthBins; ++bin) {
    const double z_m = depth_of_bin_m(bin);
    const double seen = std::accumulate(counts_[bin].begin(), counts_[bin].end(), 0.0);
    const double start_m = start_.sigma_m(z_m);
    const double measured_m = seen > 0.0 ? kDeviationOfMedian * median_m(counts_[bin], seen) : 0.0;
    const double images = seen / pixels_of_an_image;
    const double variance_m2 =
        (kImagesOfStart * start_m * start_m + images * measured_m * measured_m) /
        (kImagesOfStart + images);
    deviations.push_back({.depth_m = z_m,
                          .sigma_m = std::max(start_m, std::sqrt(variance_m2)),
                          .weight = kWeightOfStart + images});
  }
  const Eigen::Vector3d squares = fit_squares(deviations);
  return {.base_m = std::sqrt(squares(0)),
          .share = std::sqrt(squares(1)),
          .growth_per_m = std::sqrt(squares(2))};
}

}  // namespace kintsugi::mapper

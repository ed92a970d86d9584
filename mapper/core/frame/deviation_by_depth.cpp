#include "mapper/core/frame/deviation_by_depth.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace kintsugi::mapper {
namespace {

/// Weight in the fit of a depth at which nothing was counted, among those with the weight of the
/// start value.
constexpr double kLeastWeight = 0.03;

struct Deviation {
  double depth_m = 0.0;
  double sigma_m = 0.0;
  double weight = 0.0;
};

/// sigma(z)^2 = row . squares of the coefficients of DepthNoise.
Eigen::Vector3d row_at(double depth_m) {
  const double z2 = depth_m * depth_m;
  return {1.0, z2, z2 * z2};
}

/// Squares of the coefficients for which sum_i w_i ((sigma(z_i)^2 - s_i^2) / scale_i)^2 is smallest
/// among those with none negative: the best of the solutions with some of them zero.
Eigen::Vector3d fit_squares(const std::vector<Deviation>& deviations,
                            const std::vector<double>& scales_m2) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    const Deviation& deviation = deviations[i];
    const Eigen::Vector3d row = row_at(deviation.depth_m) / scales_m2[i];
    A += deviation.weight * row * row.transpose();
    b += deviation.weight * deviation.sigma_m * deviation.sigma_m / scales_m2[i] * row;
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

/// Squares of the coefficients for which sum_i w_i log(sigma(z_i)^2 / s_i^2)^2 is smallest, by
/// iteratively reweighted least squares. Of the ratio itself the smallest deviations, even those of
/// depths at which nothing was counted, would outweigh all others.
Eigen::Vector3d fit_ratios(const std::vector<Deviation>& deviations) {
  constexpr int kSteps = 15;
  constexpr double kEqual = 1e-3;  // log x = x - 1 nearly
  std::vector<double> scales_m2;
  scales_m2.reserve(deviations.size());
  for (const Deviation& deviation : deviations) {
    scales_m2.push_back(deviation.sigma_m * deviation.sigma_m);
  }
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (int step = 0; step < kSteps; ++step) {
    squares = fit_squares(deviations, scales_m2);
    for (std::size_t i = 0; i < deviations.size(); ++i) {
      const double counted_m2 = deviations[i].sigma_m * deviations[i].sigma_m;
      const double fitted_m2 = std::max(squares.dot(row_at(deviations[i].depth_m)), 1e-12);
      const double ratio = std::log(fitted_m2 / counted_m2);
      const double chord_m2 =
          std::abs(ratio) < kEqual ? counted_m2 : (fitted_m2 - counted_m2) / ratio;
      scales_m2[i] = std::sqrt(fitted_m2 * chord_m2);
    }
  }
  return squares;
}

/// The x with P(|X| < x) = quantile for X of the standard normal distribution.
double deviations_of(double quantile) {
  double x = 1.0;
  for (int i = 0; i < 20; ++i) {  // Newton's iteration
    const double density = std::sqrt(2.0 / std::numbers::pi) * std::exp(-0.5 * x * x);
    x -= (std::erf(x / std::numbers::sqrt2) - quantile) / density;
  }
  return x;
}

/// The bin of a value on a logarithmic scale.
int bin_of(double value, double smallest, double ratio, int num_bins) {
  if (!(value > smallest)) return 0;
  const float bin =
      std::log(static_cast<float>(value / smallest)) / std::log(static_cast<float>(ratio));
  return bin < static_cast<float>(num_bins) ? static_cast<int>(bin) : num_bins - 1;
}

}  // namespace

DeviationByDepth::DeviationByDepth(double quantile)
    : quantile_(quantile), deviations_of_quantile_(deviations_of(quantile)) {}

void DeviationByDepth::fade(double factor) {
  for (Histogram& histogram : counts_) {
    for (double& count : histogram) count *= factor;
  }
}

void DeviationByDepth::count(double depth_m, double error_m) {
  Histogram& histogram = counts_[bin_of(depth_m, kNearest_m, kDepthRatio, kDepthBins)];
  histogram[bin_of(error_m, kSmallest_m, kErrorRatio, kErrorBins)] += 1.0;
}

DepthNoise DeviationByDepth::fit(const DepthNoise& start, double weight_of_start,
                                 double least) const {
  std::vector<Deviation> deviations;
  for (int bin = 0; bin < kDepthBins; ++bin) {
    const double z_m = kNearest_m * std::pow(kDepthRatio, bin + 0.5);
    const double seen = std::accumulate(counts_[bin].begin(), counts_[bin].end(), 0.0);
    const double start_m = start.sigma_m(z_m);
    const double counted_m =
        seen > 0.0 ? quantile_m(counts_[bin], seen) / deviations_of_quantile_ : 0.0;
    const double variance_m2 =
        (weight_of_start * start_m * start_m + seen * counted_m * counted_m) /
        (weight_of_start + seen);
    deviations.push_back({.depth_m = z_m,
                          .sigma_m = std::max(least * start_m, std::sqrt(variance_m2)),
                          .weight = kLeastWeight + seen / weight_of_start});
  }
  const Eigen::Vector3d squares = fit_ratios(deviations);
  return {.base_m = std::sqrt(squares(0)),
          .share = std::sqrt(squares(1)),
          .growth_per_m = std::sqrt(squares(2))};
}

double DeviationByDepth::quantile_m(const Histogram& histogram, double total) const {
  double below = 0.0;
  for (int bin = 0; bin < kErrorBins; ++bin) {
    const double next = below + histogram[bin];
    if (next >= quantile_ * total && histogram[bin] > 0.0) {
      const double within = (quantile_ * total - below) / histogram[bin];
      return kSmallest_m * std::pow(kErrorRatio, bin + within);
    }
    below = next;
  }
  return kSmallest_m * std::pow(kErrorRatio, kErrorBins);
}

}  // namespace kintsugi::mapper

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
  const Eigen::Vector3d squares = fit_squares(deviations);
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

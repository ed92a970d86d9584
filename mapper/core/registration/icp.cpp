#include "mapper/core/registration/icp.hpp"

#include <algorithm>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "mapper/core/frame/kernel_arguments.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kRowsPerBand = 8;          ///< summed in single precision
constexpr int kMinPixelsPerTask = 8192;  ///< waking a thread for fewer costs more

LinearizationInput make_input(const SurfaceMap& frame_C, const SurfaceMap& model_V,
                              const Pose& X_VC, const IcpGates& gates) {
  LinearizationInput input;
  input.frame_C = planes_of(frame_C);
  input.model_V = planes_of(model_V);
  input.X_VC = rigid_motion(X_VC);
  input.max_squared_distance_m2 = static_cast<float>(gates.max_distance_m * gates.max_distance_m);
  input.max_distance_sigmas = static_cast<float>(gates.max_distance_sigmas);
  input.min_normal_cosine = static_cast<float>(gates.min_normal_cosine);
  input.variance = depth_variance(frame_C.noise);
  input.agreement_sigmas = static_cast<float>(SurfaceAgreement::kSigmas);
  input.agreement_distance_m = static_cast<float>(SurfaceAgreement::kDistance_m);
  return input;
}

/// Adds the bands in order, because the result of floating-point addition depends on it.
NormalEquations sum_of(const std::vector<LinearizationSums>& bands) {
  double products[LinearizationSums::kNumProducts] = {};
  NormalEquations equations;
  for (const LinearizationSums& band : bands) {
    for (int k = 0; k < LinearizationSums::kNumProducts; ++k) products[k] += band.products[k];
    equations.squared_residuals_m2 += band.squared_residuals_m2;
    equations.inliers += band.inliers;
    equations.agreement.overlap += band.overlap;
    equations.agreement.behind += band.behind;
    equations.agreement.in_front += band.in_front;
  }
  int k = 0;
  for (int i = 0; i < 7; ++i) {
    for (int j = i; j < 7; ++j, ++k) {
      if (j < 6) {
        equations.A(i, j) = equations.A(j, i) = products[k];
      } else if (i < 6) {
        equations.b(i) = products[k];
      } else {
        equations.weighted_squares = products[k];
      }
    }
  }
  return equations;
}

}  // namespace

NormalEquations linearize(const SurfaceMap& frame_C, const SurfaceMap& model_V, const Pose& X_VC,
                          const IcpGates& gates, const Kernels& kernels) {
  const LinearizationInput input = make_input(frame_C, model_V, X_VC, gates);
  const int rows = frame_C.depth_m.rows;
  const int pixels_per_band = kRowsPerBand * std::max(1, frame_C.depth_m.cols);
  std::vector<LinearizationSums> bands((rows + kRowsPerBand - 1) / kRowsPerBand);
  const tbb::blocked_range<int> all_bands(0, static_cast<int>(bands.size()),
                                          1 + kMinPixelsPerTask / pixels_per_band);
  tbb::parallel_for(all_bands, [&](const tbb::blocked_range<int>& range) {
    for (int band = range.begin(); band < range.end(); ++band) {
      const int first = band * kRowsPerBand;
      bands[band] = kernels.linearize_rows(input, first, std::min(first + kRowsPerBand, rows));
    }
  });
  return sum_of(bands);
}

}  // namespace kintsugi::mapper

#include "mapper/core/registration/icp.hpp"

#include <vector>

#include "mapper/core/frame/kernel_arguments.hpp"
#include "mapper/core/registration/row_bands.hpp"

namespace kintsugi::mapper {
namespace {

LinearizationInput make_input(const SurfaceMap& frame_C, const SurfaceMap& model_V,
                              const Pose& X_VC, const IcpGates& gates,
                              const std::optional<InfluenceLimits>& limits) {
  LinearizationInput input;
  input.frame_C = planes_of(frame_C);
  input.model_V = planes_of(model_V);
  input.X_VC = rigid_motion(X_VC);
  input.max_squared_distance_m2 = static_cast<float>(gates.max_distance_m * gates.max_distance_m);
  input.max_distance_sigmas = static_cast<float>(gates.max_distance_sigmas);
  input.min_normal_cosine = static_cast<float>(gates.min_normal_cosine);
  if (limits) {
    const double falling_sigmas = limits->none_sigmas - limits->full_sigmas;
    input.no_influence_sigmas = static_cast<float>(limits->none_sigmas);
    input.influence_slope = static_cast<float>(limits->full_sigmas / falling_sigmas);
  }
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
                          const IcpGates& gates, const std::optional<InfluenceLimits>& limits,
                          const Kernels& kernels) {
  const LinearizationInput input = make_input(frame_C, model_V, X_VC, gates, limits);
  return sum_of(sum_bands<LinearizationSums>(frame_C.depth_m.size(), [&](int first, int last) {
    return kernels.linearize_rows(input, first, last);
  }));
}

}  // namespace kintsugi::mapper

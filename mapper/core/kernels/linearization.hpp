#pragma once
// Sums up the normal equations of point-to-plane ICP: the innermost loop of linearize() in icp.hpp.

#include <cstdint>

#include "mapper/core/kernels/depth_variance.hpp"
#include "mapper/core/kernels/surface_planes.hpp"

namespace kintsugi::mapper {

struct LinearizationInput {
  SurfacePlanes frame_C;
  SurfacePlanes model_V;
  RigidMotion X_VC;
  // The two points of a pair are at most sqrt(max_squared_distance_m2 + (max_distance_sigmas
  // sigma)^2) apart.
  float max_squared_distance_m2 = 0.0F;
  float max_distance_sigmas = 0.0F;
  float min_normal_cosine = 0.0F;
  // A residual r, in deviations sigma, counts in b as sign(r) min(|r|, influence_slope
  // max(0, no_influence_sigmas - |r|)); without limits, as r.
  float no_influence_sigmas = 1e30F;
  float influence_slope = 1.0F;
  DepthVariance variance;  ///< of the frame's depths
  // A point is behind or in front of the model's surface when its depth differs by more than
  // max(agreement_sigmas * sigma, agreement_distance_m).
  float agreement_sigmas = 0.0F;
  float agreement_distance_m = 0.0F;
};

/// The sums over a band of rows.
struct LinearizationSums {
  static constexpr int kNumProducts = 28;
  float products[kNumProducts] = {};  ///< upper triangle of [A b; . E], row by row
  float squared_residuals_m2 = 0.0F;  ///< without weights
  std::int32_t inliers = 0;
  std::int32_t overlap = 0;
  std::int32_t behind = 0;
  std::int32_t in_front = 0;
};

/// Sums over rows [first_row, last_row) of the frame: first each of 16 lanes in the order of its
/// pixels, then over the lanes. A band should be short, because the sums are in single precision.
using LinearizeRows = LinearizationSums (*)(const LinearizationInput& input, int first_row,
                                            int last_row);

}  // namespace kintsugi::mapper

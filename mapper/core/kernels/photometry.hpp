#pragma once
// Sums up the normal equations of photometric registration: the innermost loop of
// linearize_photometric() in photometric.hpp, which has the formulas.

#include <cstdint>

#include "mapper/core/kernels/depth_variance.hpp"
#include "mapper/core/kernels/surface_planes.hpp"

namespace kintsugi::mapper {

/// Pointers to the images of an IntensityMap (see intensity.hpp), without padding between rows.
struct IntensityPlanes {
  const float* value = nullptr;
  const float* gradient_u = nullptr;
  const float* gradient_v = nullptr;
};

/// Frames: C the new frame, K the reference, V that of the increments.
struct PhotometryInput {
  SurfacePlanes surface_C;  ///< without normals
  SurfacePlanes surface_K;
  IntensityPlanes intensity_C;
  IntensityPlanes intensity_K;
  RigidMotion X_VC;
  RigidMotion X_KV;
  // A residual is I_K - gain I_C - bias.
  float gain = 1.0F;
  float bias = 0.0F;
  float weight = 0.0F;          ///< of a residual up to full_weight_up_to
  float full_weight_up_to = 0;  ///< larger ones are weighted down, after Huber
  // A point is hidden in the reference where the depth there differs from its own by more than
  // max(depth_sigmas * sigma, min_depth_step_m).
  DepthVariance variance;  ///< of the frame's depths
  float depth_sigmas = 0.0F;
  float min_depth_step_m = 0.0F;
};

/// The sums over a band of rows.
struct PhotometrySums {
  static constexpr int kNumProducts = 36;
  static constexpr int kNumCrossProducts = 21;
  /// Upper triangle of the sum of w q q', q = (row of the Jacobian, residual, 1), row by row.
  float products[kNumProducts] = {};
  /// Upper triangle of the sum of w (r o' + o r'), row by row: r the row of the Jacobian by the
  /// gradient of the reference, o by that of the new frame.
  float cross_products[kNumCrossProducts] = {};
  // Without weights.
  float squared_residuals = 0.0F;
  float moments_C[2] = {};  ///< sums of the intensities and of their squares
  float moments_K[2] = {};
  std::int32_t pixels = 0;  ///< in which both see the same surface
};

/// Sums over rows [first_row, last_row) of the new frame: first each of 16 lanes in the order of
/// its pixels, then over the lanes. A band should be short, because the sums are in single
/// precision.
using SumPhotometryRows = PhotometrySums (*)(const PhotometryInput& input, int first_row,
                                             int last_row);

}  // namespace kintsugi::mapper

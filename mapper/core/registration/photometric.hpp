#pragma once
// One linearisation of photometric registration: a frame against an earlier reference frame.
//
// Frames: C the camera of the new frame, K that of the reference frame, V the virtual camera in
// which increments are taken, as for ICP.

#include <cstdint>
#include <optional>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/intensity.hpp"
#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/kernels/kernels.hpp"
#include "mapper/core/registration/information.hpp"

namespace kintsugi::mapper {

/// One level of a frame: geometry and intensity of the same pixels.
struct PhotometricImage {
  const SurfaceMap& surface;
  const IntensityMap& intensity;
};

/// Maps the intensities of the new frame to those of the reference: gain * I_C + bias. The camera's
/// automatic exposure changes it.
struct Exposure {
  double gain = 1.0;
  double bias = 0.0;
};

/// Gauss-Newton system of the robust photometric error
///   E(X_VC) = sum_i rho_Huber((I_K(pi(X_KV X_VC p_i)) - gain I_C(i) - bias) / sigma)
/// for the left increment of X_VC, as NormalEquations. The gain makes the standard
/// deviations of both intensities equal: estimated by least squares it, and with it the error,
/// would shrink the worse the two are aligned. The bias is eliminated by the Schur complement,
/// which takes what it explains out of the information. The second measurement of each gradient
/// (see observability.hpp) is that of the new frame.
struct PhotometricEquations {
  Information information;
  Vector6d b = Vector6d::Zero();
  Exposure exposure;           ///< fitted to these pixels
  double rms = 0.0;            ///< of the residuals, intensity
  double mean_residual = 0.0;  ///< weighted
  std::int64_t pixels = 0;     ///< in which both see the same surface
};

struct PhotometricConfig {
  double sigma = 0.015;         ///< standard deviation of a residual; intensities are 0 to 1
  double huber_sigmas = 1.345;  ///< larger residuals are weighted down
  /// A point is hidden in the reference where it differs from the depth there by more than
  /// max(depth_sigmas * sigma(z), min_depth_step_m).
  double depth_sigmas = 3.0;
  double min_depth_step_m = 0.02;

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// `exposure`: as of the step before; where there is none yet, all pixels have the same weight. The
/// result depends neither on the number of threads nor on the instruction set.
PhotometricEquations linearize_photometric(const PhotometricImage& frame_C,
                                           const PhotometricImage& reference_K, const Pose& X_VC,
                                           const Pose& X_KV,
                                           const std::optional<Exposure>& exposure,
                                           const PhotometricConfig& config,
                                           const Kernels& kernels = best_kernels());

}  // namespace kintsugi::mapper

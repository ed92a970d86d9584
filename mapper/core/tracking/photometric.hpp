#pragma once
// One linearisation of frame-to-keyframe registration by brightness.
//
// Frames: C the camera of the new frame, K that of a frame seen before, V the virtual camera in
// which increments are taken, as for ICP.

#include <cstdint>
#include <optional>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/intensity.hpp"
#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/tracking/observability.hpp"

namespace kintsugi::mapper {

/// One level of a view: geometry and brightness of the same pixels.
struct PhotometricImage {
  const SurfaceMap& surface;
  const IntensityMap& intensity;
};

/// How the brightness of the new frame maps to the keyframe's: gain * I_C + bias. It follows
/// auto-exposure.
struct Exposure {
  double gain = 1.0;
  double bias = 0.0;
};

/// Gauss-Newton system of the robust photometric error
///   E(X_VC) = sum_i rho_Huber((I_K(pi(X_KV X_VC p_i)) - gain I_C(i) - bias) / sigma)
/// for the left increment of X_VC, as NormalEquations. The gain makes the spread of both
/// brightnesses equal (by least squares it would shrink, and the error with it, the worse the two
/// are aligned); the bias is eliminated (Schur complement): what it explains is no information on
/// the motion. The second measurement of each gradient (see observability.hpp) is that of the new
/// frame.
struct PhotometricEquations {
  Information information;
  Vector6d b = Vector6d::Zero();
  Exposure exposure;           ///< that fits these pixels
  double rms = 0.0;            ///< of the residuals, brightness
  double mean_residual = 0.0;  ///< weighted
  std::int64_t pixels = 0;     ///< that are seen by both, on the same surface
};

struct PhotometricConfig {
  double sigma = 0.015;            ///< of a brightness (0 to 1) against the keyframe's
  double huber_sigmas = 1.345;     ///< residuals beyond are weighted down
  double depth_sigmas = 3.0;       ///< a point hidden in the keyframe lies farther than this many
  double min_depth_step_m = 0.02;  ///< standard deviations, and this, behind what the keyframe saw

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// `exposure`: that of the step before; absent: none is known, and all pixels weigh the same. The
/// result does not depend on the number of threads.
PhotometricEquations linearize_photometric(const PhotometricImage& frame_C,
                                           const PhotometricImage& keyframe_K, const Pose& X_VC,
                                           const Pose& X_KV,
                                           const std::optional<Exposure>& exposure,
                                           const PhotometricConfig& config);

}  // namespace kintsugi::mapper

#pragma once
// Learns the noise of a camera's depth from the residuals of tracking.

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/depth_noise.hpp"
#include "mapper/core/frame/deviation_by_depth.hpp"
#include "mapper/core/frame/surface_map.hpp"

namespace kintsugi::mapper {

/// Estimates DepthNoise from how far the points of registered frames are from the model.
///
/// The residuals, along the camera's z, are counted by depth (see DeviationByDepth). The start
/// value counts like a few images, and it is the least value: the residuals of a camera that is
/// more precise are those of the model, which the same weights suit. Older frames count less and
/// less, so that the estimate follows a camera that warms up.
class NoiseEstimator {
 public:
  explicit NoiseEstimator(const DepthNoise& start) : start_(start), noise_(start) {}

  /// Counts a frame that was registered with a model: V is the model's camera, C the frame's.
  void add(const SurfaceMap& frame_C, const SurfaceMap& model_V, const Pose& X_VC);

  const DepthNoise& noise() const { return noise_; }

 private:
  DepthNoise start_;
  DepthNoise noise_;
  DeviationByDepth residuals_{0.5};
};

}  // namespace kintsugi::mapper

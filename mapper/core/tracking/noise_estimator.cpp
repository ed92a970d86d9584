#include "mapper/core/tracking/noise_estimator.hpp"

#include <cmath>

#include "mapper/core/frame/camera.hpp"

namespace kintsugi::mapper {
namespace {

/// What a frame counts after each further one: 500 frames, 17 seconds, remain in effect.
constexpr double kDecay = 0.998;
/// Pairs whose points are farther apart, in deviations of the estimate so far, show different
/// surfaces. The estimate can still grow: half of the pairs that are left count less than it.
constexpr double kMaxSigmas = 6.0;
/// Steeper surfaces show the error across the image, not that of the depth.
constexpr float kMinCosine = 0.5F;
/// The start value counts like so many images at each depth.
constexpr double kImagesOfStart = 3.0;
/// No deviation is below that of the start value.
constexpr double kLeastShare = 1.0;

}  // namespace

void NoiseEstimator::add(const SurfaceMap& frame_C, const SurfaceMap& model_V, const Pose& X_VC) {
  const PinholeCamera camera = pinhole_camera(model_V.intrinsics);
  const Eigen::Isometry3f X = X_VC.cast<float>();
  residuals_.fade(kDecay);
  for (int v = 0; v < frame_C.depth_m.rows; ++v) {
    for (int u = 0; u < frame_C.depth_m.cols; ++u) {
      const float depth_m = frame_C.depth_m(v, u);
      if (!(depth_m >= static_cast<float>(DeviationByDepth::kNearest_m)) ||
          std::isnan(frame_C.normal_z(v, u))) {
        continue;
      }
      const Eigen::Vector3f p = X * frame_C.point(v, u);
      const float x = camera.fx * p.x() / p.z() + camera.cx + 0.5F;
      const float y = camera.fy * p.y() / p.z() + camera.cy + 0.5F;
      if (!(p.z() > 0.0F && x >= 0.0F && y >= 0.0F)) continue;
      if (!(x < static_cast<float>(camera.width) && y < static_cast<float>(camera.height)))
        continue;
      const int col = static_cast<int>(x);
      const int row = static_cast<int>(y);
      const Eigen::Vector3f normal = model_V.normal(row, col);
      const float cosine = -normal.dot(p.normalized());
      if (!(cosine > kMinCosine)) continue;
      const float across_m = normal.dot(p - model_V.point(row, col));
      const float residual_m = std::abs(across_m / (cosine * p.norm())) * p.z();
      if (!(residual_m < kMaxSigmas * noise_.sigma_m(depth_m))) continue;
      residuals_.count(depth_m, residual_m);
    }
  }
  noise_ = residuals_.fit(start_, kImagesOfStart * static_cast<double>(frame_C.depth_m.total()),
                          kLeastShare);
}

}  // namespace kintsugi::mapper

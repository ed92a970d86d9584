#include "mapper/core/relocalization/intensity_agreement.hpp"

#include <cmath>

namespace kintsugi::mapper {
namespace {

constexpr double kSameSurface_m = 0.05;
constexpr double kMinCommonShare = 0.15;      ///< of all pixels
constexpr double kMinDeviation_levels = 6.0;  ///< of each image's intensities (0 to 255)

/// Sums for the correlation of pairs of intensities.
struct Moments {
  double n = 0, a = 0, b = 0, aa = 0, ab = 0, bb = 0;

  void add(double x, double y) {
    n += 1.0;
    a += x;
    b += y;
    aa += x * x;
    ab += x * y;
    bb += y * y;
  }
  double variance_a() const { return aa / n - a / n * (a / n); }
  double variance_b() const { return bb / n - b / n * (b / n); }
  double covariance() const { return ab / n - a / n * (b / n); }
};

}  // namespace

std::optional<double> intensity_agreement(const SurfaceMap& surface_C,
                                          const cv::Mat_<std::uint8_t>& intensity_C,
                                          const SurfaceMap& surface_K,
                                          const cv::Mat_<std::uint8_t>& intensity_K,
                                          const Pose& X_KC) {
  const Intrinsics& camera_K = surface_K.intrinsics;
  const Eigen::Isometry3f X = X_KC.cast<float>();
  Moments moments;
  for (int v = 0; v < surface_C.depth_m.rows; ++v) {
    for (int u = 0; u < surface_C.depth_m.cols; ++u) {
      const Eigen::Vector3f p_K = X * surface_C.point(v, u);
      if (!(p_K.z() > 0.0F)) continue;  // NaN too
      const double u_K = camera_K.fx * p_K.x() / p_K.z() + camera_K.cx + 0.5;
      const double v_K = camera_K.fy * p_K.y() / p_K.z() + camera_K.cy + 0.5;
      if (!(u_K >= 0.0 && v_K >= 0.0 && u_K < camera_K.width && v_K < camera_K.height)) continue;
      const int col = static_cast<int>(u_K);
      const int row = static_cast<int>(v_K);
      if (!(std::abs(surface_K.depth_m(row, col) - p_K.z()) < kSameSurface_m)) continue;
      moments.add(intensity_C(v, u), intensity_K(row, col));
    }
  }
  if (moments.n < kMinCommonShare * static_cast<double>(surface_C.depth_m.total())) {
    return std::nullopt;
  }
  const double least_variance = kMinDeviation_levels * kMinDeviation_levels;
  if (moments.variance_a() < least_variance || moments.variance_b() < least_variance) {
    return std::nullopt;
  }
  return moments.covariance() / std::sqrt(moments.variance_a() * moments.variance_b());
}

}  // namespace kintsugi::mapper

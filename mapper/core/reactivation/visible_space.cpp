#include "mapper/core/reactivation/visible_space.hpp"

#include <algorithm>
#include <cmath>

namespace kintsugi::mapper {
namespace {

constexpr int kCell_px = 16;

}  // namespace

VisibleSpace::VisibleSpace(const cv::Mat_<float>& depth_m, const Intrinsics& camera,
                           const Pose& X_UC, double margin_m)
    : camera_(camera),
      X_CU_(X_UC.inverse(Eigen::Isometry)),
      margin_m_(margin_m),
      farthest_m_((depth_m.rows + kCell_px - 1) / kCell_px,
                  (depth_m.cols + kCell_px - 1) / kCell_px, 0.0F) {
  for (int v = 0; v < depth_m.rows; ++v) {
    const float* const row = depth_m[v];
    float* const cells = farthest_m_[v / kCell_px];
    for (int u = 0; u < depth_m.cols; ++u) {
      float& cell = cells[u / kCell_px];
      if (row[u] > cell) cell = row[u];  // false for NaN
    }
  }
  for (const float farthest_m : farthest_m_) {
    longest_m_ = std::max(longest_m_, static_cast<double>(farthest_m));
  }
}

bool VisibleSpace::meets(const Eigen::Vector3d& center_U, double radius_m) const {
  const Eigen::Vector3d p_C = X_CU_ * center_U;
  const double nearest_m = p_C.z() - radius_m;
  if (p_C.z() + radius_m <= 0.0 || nearest_m > longest_m_ + margin_m_) return false;
  // A ball that the camera is in, or almost, may be anywhere in the image.
  const double z = std::max(nearest_m, radius_m);
  const double reach_u = camera_.fx * radius_m / z;
  const double reach_v = camera_.fy * radius_m / z;
  const double u = camera_.fx * p_C.x() / std::max(p_C.z(), radius_m) + camera_.cx;
  const double v = camera_.fy * p_C.y() / std::max(p_C.z(), radius_m) + camera_.cy;
  const auto first = [](double px) {
    return std::max(0, static_cast<int>(std::floor(px / kCell_px)));
  };
  const auto last = [](double px, int cells) {
    return static_cast<int>(std::min(std::floor(px / kCell_px), cells - 1.0));
  };
  for (int j = first(v - reach_v); j <= last(v + reach_v, farthest_m_.rows); ++j) {
    for (int i = first(u - reach_u); i <= last(u + reach_u, farthest_m_.cols); ++i) {
      const float farthest_m = farthest_m_(j, i);
      if (farthest_m > 0.0F && nearest_m <= farthest_m + margin_m_) return true;
    }
  }
  return false;
}

}  // namespace kintsugi::mapper

#include "mapper/core/loop_closure/common_view.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kSampleStep_px = 8;

}  // namespace

double common_share(const Keyframe& L, const Keyframe& E, const Pose& X_EL) {
  // Views in opposite directions have no surface in common; most pairs end here.
  if (X_EL.linear()(2, 2) <= 0.0) return 0.0;
  int num_points = 0;
  int num_common = 0;
  for (int v = kSampleStep_px / 2; v < L.camera.height; v += kSampleStep_px) {
    for (int u = kSampleStep_px / 2; u < L.camera.width; u += kSampleStep_px) {
      if (!(L.depth_m(v, u) > 0.0)) continue;
      ++num_points;
      const Eigen::Vector3d p_E = X_EL * L.point(v, u);
      if (!(p_E.z() > 0.0)) continue;
      const double u_E = E.camera.fx * p_E.x() / p_E.z() + E.camera.cx;
      const double v_E = E.camera.fy * p_E.y() / p_E.z() + E.camera.cy;
      if (!(u_E >= 0.0 && v_E >= 0.0 && u_E < E.camera.width && v_E < E.camera.height)) continue;
      const double seen_m = E.depth_m(static_cast<int>(v_E), static_cast<int>(u_E));
      // Half and double: the rest is for the registration to find out.
      if (seen_m > 0.5 * p_E.z() && seen_m < 2.0 * p_E.z()) ++num_common;
    }
  }
  return num_points == 0 ? 0.0 : static_cast<double>(num_common) / num_points;
}

}  // namespace kintsugi::mapper

#include "viewer/core/camera/frustum.hpp"

#include <algorithm>
#include <cstddef>

namespace kintsugi::viewer {

Frustum frustum_of(const Pose& X_WC, double size_m) {
  // Half the width and height of the field of view of a Kinect, 57 x 43 degrees, at a distance
  // of 1.
  constexpr double kHalfWidth = 0.54;
  constexpr double kHalfHeight = 0.40;
  constexpr std::array<std::array<int, 2>, 4> kSigns{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  Frustum frustum;
  frustum.apex_W = X_WC.translation();
  for (std::size_t i = 0; i < kSigns.size(); ++i) {
    const Eigen::Vector3d corner_C(kSigns[i][0] * kHalfWidth, kSigns[i][1] * kHalfHeight, 1.0);
    frustum.base_W[i] = X_WC * (size_m * corner_C);
  }
  return frustum;
}

bool is_in_picture(const Frustum& frustum, const VirtualCamera& camera) {
  const Pose X_VW = camera.X_WV.inverse();
  const Intrinsics& k = camera.intrinsics;
  return std::ranges::all_of(frustum.corners_W(), [&](const Eigen::Vector3d& corner_W) {
    const Eigen::Vector3d p_V = X_VW * corner_W;
    const double u_z = k.fx * p_V.x() + k.cx * p_V.z();
    const double v_z = k.fy * p_V.y() + k.cy * p_V.z();
    return p_V.z() > 0.0 && u_z >= 0.0 && u_z <= (k.width - 1) * p_V.z() && v_z >= 0.0 &&
           v_z <= (k.height - 1) * p_V.z();
  });
}

}  // namespace kintsugi::viewer

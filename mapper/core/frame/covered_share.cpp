#include "mapper/core/frame/covered_share.hpp"

#include <cstdint>

#include "mapper/core/frame/kernel_arguments.hpp"

namespace kintsugi::mapper {

double covered_share(const SurfaceMap& frame_C, const Pose& X_WC,
                     const Eigen::AlignedBox3d& region_W, const Kernels& kernels) {
  BoxCount input;
  input.frame_C = planes_of(frame_C);
  input.X_WC = rigid_motion(X_WC);
  for (int axis = 0; axis < 3; ++axis) {
    // Relative to the camera: positions in W can be too large for single precision.
    input.X_WC.t[axis] = 0.0F;
    input.min_W[axis] = static_cast<float>(region_W.min()(axis) - X_WC.translation()(axis));
    input.max_W[axis] = static_cast<float>(region_W.max()(axis) - X_WC.translation()(axis));
  }
  std::int64_t covered = 0;
  for (int v = 0; v < frame_C.depth_m.rows; ++v) covered += kernels.count_in_box(input, v);
  return static_cast<double>(covered) / static_cast<double>(frame_C.depth_m.total());
}

}  // namespace kintsugi::mapper

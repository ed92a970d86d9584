#include "mapper/core/fusion/raycaster.hpp"

#include <vector>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/frame/camera.hpp"
#include "mapper/core/frame/surface_pyramid.hpp"
#include "mapper/core/fusion/ray_tiles.hpp"
#include "mapper/core/kernels/kernels.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {
namespace {

/// All but the images.
RaycastArguments make_arguments(const PinholeCamera& camera, const Pose& X_WC,
                                const TsdfVolume& volume) {
  const double resolution_m = volume.config().resolution_m;
  const BlockCoord& min = volume.min_block();
  const Eigen::Vector3d corner_vox = Eigen::Vector3d(min.x, min.y, min.z) * kBlockSide;
  const Eigen::Vector3d origin_vox = X_WC.translation() / resolution_m - corner_vox;
  RaycastArguments arguments{.camera = camera};
  for (int axis = 0; axis < 3; ++axis) {
    arguments.origin_vox[axis] = static_cast<float>(origin_vox[axis]);
    for (int axis_C = 0; axis_C < 3; ++axis_C) {
      arguments.vox_per_m[axis][axis_C] =
          static_cast<float>(X_WC.linear()(axis, axis_C) / resolution_m);
    }
  }
  return arguments;
}

}  // namespace

void Raycaster::Config::validate() const {
  check_range("min_depth_m", min_depth_m, 0.01, 100.0);
  check_range("max_depth_m", max_depth_m, min_depth_m, 100.0);
  if (instruction_set) kernels_for(*instruction_set);
}

Raycaster::Raycaster(const Config& config) : config_(config) {
  config_.validate();
  instruction_set_ = config_.instruction_set ? *config_.instruction_set : best_instruction_set();
}

SurfaceMap Raycaster::raycast(const TsdfVolume& volume, const Pose& X_WC,
                              const Intrinsics& intrinsics,
                              const cv::Mat_<float>& guide_depth_m) const {
  check_camera(intrinsics, X_WC);
  const Kernels& kernels = kernels_for(instruction_set_);
  const PinholeCamera camera = pinhole_camera(intrinsics);
  const std::vector<RaycastTile> tiles =
      find_ray_tiles(volume, camera, X_WC, static_cast<float>(config_.min_depth_m),
                     static_cast<float>(config_.max_depth_m));
  const cv::Mat_<float> guide_m =
      guide_depth_m.isContinuous() ? guide_depth_m : guide_depth_m.clone();
  cv::Mat_<float> depth_m(intrinsics.height, intrinsics.width);

  const VolumeAccess access = volume.kernel_access();
  RaycastArguments arguments = make_arguments(camera, X_WC, volume);
  arguments.guide_m = guide_m.ptr<float>();
  arguments.guide_columns = guide_m.cols;
  arguments.guide_rows = guide_m.rows;
  arguments.guide_margin_m = 2.0F * volume.truncation_m();
  arguments.depth_m = depth_m.ptr<float>();
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, tiles.size(), 16), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      kernels.raycast_tile(access, arguments, tiles[i]);
    }
  });
  return surface_from_depth(depth_m, intrinsics, {}, kernels);
}

}  // namespace kintsugi::mapper

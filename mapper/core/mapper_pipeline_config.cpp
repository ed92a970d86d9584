#include <algorithm>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/frame/sensors.hpp"
#include "mapper/core/fusion/truncation.hpp"
#include "mapper/core/mapper_pipeline.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kRaysBeyondRange = 1.2;  // the camera may have moved back from what it mapped

}  // namespace

void MapperPipeline::Config::set_max_range(double max_range_m) {
  limit_range_by_noise = max_range_m == 0.0;
  if (limit_range_by_noise) {
    const double by_noise_m = range_of(noise.value_or(DepthNoise()),
                                       volume.resolution_m * volume.largest_truncation_vox());
    max_range_m = std::min({by_noise_m, TsdfVolume::longest_range_m(volume), kLongestDepth_m});
  }
  volume.max_range_m = max_range_m;
  integrator.max_depth_m = max_range_m;
  raycaster.max_depth_m = max_range_m * kRaysBeyondRange;
}

LoopClosure::Config MapperPipeline::Config::loop_closure() const {
  LoopClosure::Config config = loops;
  const double voxel_m = volume.resolution_m;
  config.voxel_m = voxel_m;
  config.closer.graph.voxel_m = voxel_m;
  config.closer.verifier.voxel_m = voxel_m;
  config.closer.verifier.registration = tracker.registration;
  config.closer.graph.max_drift_share = tracker.max_drift_share;
  config.max_speed = tracker.max_speed;
  config.reach_m = integrator.max_depth_m;
  config.closer.graph.near_m = integrator.max_depth_m;
  return config;
}

void MapperPipeline::Config::validate() const {
  validate_map();
  integrator.validate();
  raycaster.validate();
  tracker.validate();
  relocalizer.validate();
  loops.validate();
  check_range("restart_after_s", restart_after_s, 0.0, 1e6);
  check_range("finest_tracking_width_px", finest_tracking_width_px, 16, 16384);
}

}  // namespace kintsugi::mapper

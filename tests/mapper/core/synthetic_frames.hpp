#pragma once
// Frames of a synthetic scene as the pipeline takes them, with their true poses.

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "lcmtypes/trajectory.hpp"
#include "mapper/core/frame/rgbd_frame.hpp"
#include "mapper/core/frame/surface_pyramid.hpp"
#include "mapper/synthetic/render/renderer.hpp"
#include "mapper/synthetic/rooms/scenes.hpp"
#include "mapper/synthetic/sensors/sensors.hpp"

namespace kintsugi::mapper::testing {

struct SyntheticRun {
  std::vector<RgbdFrame> frames;
  Trajectory true_path;  ///< in the scene's frame
};

inline cv::Mat_<float> metres(const cv::Mat_<std::uint16_t>& depth_mm) {
  cv::Mat_<float> depth_m;
  depth_mm.convertTo(depth_m, CV_32F, 1e-3);
  depth_m.setTo(std::numeric_limits<float>::quiet_NaN(), depth_mm == 0);
  return depth_m;
}

/// `count` frames of the scene's path, 320x240, every `step`-th from frame `first` on. A closed
/// path goes on after its end.
inline SyntheticRun synthetic_run(const std::string& scene_name, int count, bool noise,
                                  int step = 1, int first = 0) {
  const synthetic::SceneWithPath world = synthetic::make_scene_with_path(scene_name);
  const auto sensor = synthetic::make_sensor({.noise = noise});
  const Intrinsics camera = half_size(synthetic::default_intrinsics());
  SyntheticRun run;
  const int laps = world.trajectory.is_closed() ? 100 : 1;
  for (int i = first; i < first + count * step; i += step) {
    const std::int64_t utime = synthetic::frame_utime(i);
    const Pose X_WC = world.trajectory.X_WC(1e-6 * static_cast<double>(utime), laps);
    const synthetic::RenderedFrame picture = synthetic::render(world.scene, camera, X_WC);
    RgbdFrame frame;
    frame.utime = utime;
    frame.frame_index = i;
    frame.intrinsics = camera;
    frame.depth_m = metres(sensor->apply(picture, i));
    frame.color_rgb = picture.color_rgb;
    run.frames.push_back(frame);
    run.true_path.push_back({utime, X_WC});
  }
  return run;
}

inline RgbdFrame blank(RgbdFrame frame) {
  frame.depth_m = cv::Mat_<float>(frame.depth_m.size(), std::numeric_limits<float>::quiet_NaN());
  return frame;
}

}  // namespace kintsugi::mapper::testing

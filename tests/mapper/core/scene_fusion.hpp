#pragma once
// Volumes fused from noise-free pictures of the synthetic scenes, at their true poses.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "mapper/core/frame/rgbd_frame.hpp"
#include "mapper/core/fusion/integrator.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"
#include "mapper/synthetic/render/renderer.hpp"
#include "mapper/synthetic/rooms/scenes.hpp"
#include "mapper/synthetic/scene/scene.hpp"

namespace kintsugi::mapper::testing {

struct View {
  RgbdFrame frame;
  Pose X_WC = Pose::Identity();
};

/// 320 x 240, the field of view of a Kinect.
inline Intrinsics small_camera() {
  return {.fx = 262.5, .fy = 262.5, .cx = 159.5, .cy = 119.5, .width = 320, .height = 240};
}

/// Of any size, about as wide a view.
inline Intrinsics camera_of(int width, int height) {
  const double f = 0.82 * width;
  return {.fx = f,
          .fy = f,
          .cx = 0.5 * width - 0.5,
          .cy = 0.5 * height - 0.5,
          .width = width,
          .height = height};
}

inline View make_view(const synthetic::Scene& scene, const Pose& X_WC,
                      const Intrinsics& camera = small_camera()) {
  const synthetic::RenderedFrame rendered = synthetic::render(scene, camera, X_WC);
  View view;
  view.frame.intrinsics = camera;
  view.frame.depth_m = rendered.depth_m;
  view.frame.color_rgb = rendered.color_rgb;
  view.X_WC = X_WC;
  return view;
}

/// Views of the origin from all sides: rings at several heights.
inline std::vector<View> views_around(const synthetic::Scene& scene, double distance_m,
                                      const std::vector<double>& elevations_rad, int per_ring) {
  std::vector<View> views;
  for (const double elevation : elevations_rad) {
    for (int i = 0; i < per_ring; ++i) {
      const double azimuth = 2 * std::numbers::pi * (i + 0.1) / per_ring;
      const Eigen::Vector3d direction_W(std::cos(elevation) * std::cos(azimuth),
                                        std::cos(elevation) * std::sin(azimuth),
                                        std::sin(elevation));
      views.push_back(
          make_view(scene, synthetic::look_at(distance_m * direction_W, Eigen::Vector3d::Zero())));
    }
  }
  return views;
}

/// Views along a scene's own path, evenly in time.
inline std::vector<View> views_along_path(const synthetic::SceneWithPath& scene, int num_views,
                                          const Intrinsics& camera = small_camera()) {
  std::vector<View> views;
  for (int i = 0; i < num_views; ++i) {
    const double t_s = scene.trajectory.duration_s() * i / num_views;
    views.push_back(make_view(scene.scene, scene.trajectory.X_WC(t_s), camera));
  }
  return views;
}

/// Unit; away from the nearest surface in free space.
inline Eigen::Vector3d gradient_of_distance(const synthetic::Scene& scene,
                                            const Eigen::Vector3d& p_W) {
  constexpr double kStep_m = 1e-3;
  Eigen::Vector3d gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kStep_m * Eigen::Vector3d::Unit(axis);
    gradient[axis] = scene.signed_distance(p_W + step) - scene.signed_distance(p_W - step);
  }
  return gradient.normalized();
}

/// The value that `share` of the values are not above; 1: the greatest.
inline double percentile(std::vector<double> values, double share) {
  const auto index = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[index];
}

inline void fuse(const std::vector<View>& views, TsdfVolume& volume,
                 const Integrator::Config& config = {}) {
  const Integrator integrator(config);
  for (const View& view : views) integrator.integrate(view.frame, view.X_WC, volume);
}

}  // namespace kintsugi::mapper::testing

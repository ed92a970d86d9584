#pragma once
// Views of a camera that sees known surfaces.

#include <cmath>
#include <cstddef>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter::testing {

/// A camera of 640 x 480 pixels, of which every fourth is in the view; nothing is measured yet.
inline CameraView blind_view(std::int64_t session, const Pose& X_WC) {
  CameraView view;
  view.utime = 1'000'000;
  view.session = session;
  view.map_name = "map";
  view.state = TrackingState::kTracking;
  view.X_WC = X_WC;
  view.intrinsics = {.fx = 525, .fy = 525, .cx = 319.5, .cy = 239.5, .width = 640, .height = 480};
  view.depth_step = 4;
  view.depth_mm.assign(
      static_cast<std::size_t>(view.depth_width()) * static_cast<std::size_t>(view.depth_height()),
      0);
  return view;
}

inline std::uint16_t& depth_mm(CameraView& view, int i, int j) {
  return view.depth_mm.at(static_cast<std::size_t>(j) *
                              static_cast<std::size_t>(view.depth_width()) +
                          static_cast<std::size_t>(i));
}

/// The camera looks straight at a wall that it measures everywhere.
inline CameraView view_of_wall(std::int64_t session, const Pose& X_WC, double distance_m) {
  CameraView view = blind_view(session, X_WC);
  for (std::uint16_t& depth_mm : view.depth_mm) {
    depth_mm = static_cast<std::uint16_t>(std::lround(1e3 * distance_m));
  }
  return view;
}

/// The pose of a camera at (x, y, z) that looks straight down.
inline Pose looking_down(double x, double y, double z) {
  Pose X_WC = Pose::Identity();
  X_WC.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()).matrix();
  X_WC.translation() << x, y, z;
  return X_WC;
}

}  // namespace kintsugi::segmenter::testing

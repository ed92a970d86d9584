#pragma once
// Frames and models of the room of box_room.hpp, as the tracker takes them.

#include <cmath>
#include <cstdint>

#include "mapper/core/tracking/tracker.hpp"
#include "tests/mapper/core/box_room.hpp"

namespace kintsugi::mapper::testing {

inline constexpr std::int64_t kFrame_us = 33333;

inline Vector6d twist(double x, double y, double z, double a, double b, double c) {
  Vector6d xi;
  xi << x, y, z, a, b, c;
  return xi;
}

inline TrackingInput frame_at(const Pose& X_WC, std::int64_t utime) {
  const Intrinsics camera = test_camera();
  return {utime, pyramid_from_depth(render_depth(X_WC, camera), camera, 0, 3, 10.0F), {}};
}

inline TrackingInput blank_frame(std::int64_t utime) {
  const Intrinsics camera = test_camera();
  const cv::Mat_<float> depth(camera.height, camera.width, std::nanf(""));
  return {utime, pyramid_from_depth(depth, camera, 0, 3, 10.0F), {}};
}

inline Model model_at(const Pose& X_WV) {
  return {pyramid_from_surface(render_room(X_WV, test_camera()), 3), X_WV};
}

// Normals of a frame come from differences and are wrong along creases, where pairs of two
// different planes may pass the gates: a small part of the pixels, with residuals of up to a
// pixel's footprint (8 mm at 2 m). Measured: 0.1 mm and 0.05 mrad; bounds with a factor.
inline constexpr double kExactData_m = 5e-4;
inline constexpr double kExactData_rad = 3e-4;

}  // namespace kintsugi::mapper::testing

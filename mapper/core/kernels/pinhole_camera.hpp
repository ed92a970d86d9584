#pragma once

namespace kintsugi::mapper {

/// A pinhole camera without lens distortion, in single precision: the one camera that kernels and
/// loops over pixels use. pinhole_camera() makes it from the calibrated Intrinsics.
///
/// Pixel (u, v) with depth z is the point (z (u - cx) / fx, z (v - cy) / fy, z); integer
/// coordinates are pixel centres.
struct PinholeCamera {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  float fx = 0.0F;
  float fy = 0.0F;
  float cx = 0.0F;
  float cy = 0.0F;
  float inverse_fx = 0.0F;  ///< rounded from double precision: not always 1.0F / fx
  float inverse_fy = 0.0F;
};

}  // namespace kintsugi::mapper

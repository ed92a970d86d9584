#pragma once
// Surfaces from depth images, at several levels of detail.

#include <limits>
#include <vector>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/camera.hpp"
#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/kernels/kernels.hpp"

namespace kintsugi::mapper {

/// One surface at several sizes, finest first; each level has half the width and height of the one
/// before it.
using SurfacePyramid = std::vector<SurfaceMap>;

/// Halves a depth image (metres, invalid is NaN): each pixel is the mean of those of its 2x2 depths
/// that may lie on the same surface as the nearest, so that no depth lies between two surfaces (see
/// DepthTolerance; that of the larger image). Depths beyond `max_depth_m` are invalid.
cv::Mat_<float> half_size(const cv::Mat_<float>& depth_m, const DepthTolerance& tolerance,
                          float max_depth_m = std::numeric_limits<float>::infinity(),
                          const Kernels& kernels = best_kernels());

/// Back-projects a depth image (metres along C's z, invalid is NaN; `intrinsics` without distortion
/// and of the image's size) and takes normals from central differences. A pixel at the border, or
/// with a neighbour that is invalid or on another surface (see DepthTolerance), keeps its depth but
/// has no normal (NaN).
/// @throws std::invalid_argument if the size of the image is not that of the intrinsics
SurfaceMap surface_from_depth(const cv::Mat_<float>& depth_m, const Intrinsics& intrinsics,
                              const SensorNoise& noise = {},
                              const Kernels& kernels = best_kernels());

/// The pyramid of a measured depth image, halved `skip` times (1: a 640x480 image starts at
/// 320x240), with `levels` levels. Depths beyond `max_depth_m` are invalid. The normals of the two
/// finest levels are those of a smoothed image: from neighbouring pixels of a camera 3 m away they
/// would be noise. The depths are not smoothed.
/// @throws std::invalid_argument if the size of the image is not that of the intrinsics
SurfacePyramid pyramid_from_depth(const cv::Mat_<float>& depth_m, const Intrinsics& intrinsics,
                                  int skip, int levels, float max_depth_m,
                                  const SensorNoise& noise = {},
                                  const Kernels& kernels = best_kernels());

/// The pyramid of a raycast surface: depths and normals are averaged over those of 2x2 pixels that
/// may lie on the same surface as the nearest (see DepthTolerance).
SurfacePyramid pyramid_from_surface(SurfaceMap finest, int levels,
                                    const Kernels& kernels = best_kernels());

}  // namespace kintsugi::mapper

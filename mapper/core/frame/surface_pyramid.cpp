#include "mapper/core/frame/surface_pyramid.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "mapper/core/frame/kernel_arguments.hpp"

namespace kintsugi::mapper {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr int kSmoothedLevels = 2;        ///< the coarser ones average enough pixels already
constexpr int kMinPixelsPerTask = 16384;  ///< waking a thread for fewer costs more

template <typename Row>
void for_each_row(cv::Size size, const Row& row) {
  const int grain = 1 + kMinPixelsPerTask / std::max(1, size.width);
  tbb::parallel_for(tbb::blocked_range<int>(0, size.height, grain),
                    [&](const tbb::blocked_range<int>& range) {
                      for (int v = range.begin(); v != range.end(); ++v) row(v);
                    });
}

cv::Mat_<float> smoothed(const cv::Mat_<float>& depth_m, const DepthTolerance& tolerance,
                         const Kernels& kernels) {
  constexpr int kPad = kSmoothingReach_px;
  cv::Mat_<float> padded;
  cv::copyMakeBorder(depth_m, padded, kPad, kPad, kPad, kPad, cv::BORDER_CONSTANT,
                     cv::Scalar(kNaN));
  cv::Mat_<float> result(depth_m.size());
  for_each_row(depth_m.size(), [&](int v) {
    kernels.smooth_depth_row(padded[0], depth_m.cols, v, tolerance, result[v]);
  });
  return result;
}

/// The result shares the depth image.
SurfaceMap surface_of(cv::Mat_<float> depth_m, const Intrinsics& intrinsics,
                      const SensorNoise& noise, bool smooth_normals, const Kernels& kernels) {
  SurfaceMap surface(intrinsics);
  surface.noise = noise.depth;
  surface.local_noise = noise.local;
  surface.depth_m = std::move(depth_m);
  const DepthTolerance tolerance = depth_tolerance(noise.local, intrinsics);
  const cv::Mat_<float> depth_of_normals_m =
      smooth_normals ? smoothed(surface.depth_m, tolerance, kernels) : surface.depth_m;
  const MutableSurfacePlanes planes = planes_of(surface);
  for_each_row(surface.depth_m.size(),
               [&](int v) { kernels.normals_row(depth_of_normals_m[0], tolerance, v, planes); });
  return surface;
}

SurfaceMap half_size_surface(const SurfaceMap& fine, const Kernels& kernels) {
  SurfaceMap half(half_size(fine.intrinsics));
  half.noise = fine.noise;
  half.local_noise = fine.local_noise;
  const DepthTolerance tolerance = depth_tolerance(fine.local_noise, fine.intrinsics);
  const SurfacePlanes from = planes_of(fine);
  const MutableSurfacePlanes to = planes_of(half);
  for_each_row(half.depth_m.size(),
               [&](int v) { kernels.halve_surface_row(from, tolerance, v, to); });
  return half;
}

}  // namespace

cv::Mat_<float> half_size(const cv::Mat_<float>& depth_m, const DepthTolerance& tolerance,
                          float max_depth_m, const Kernels& kernels) {
  cv::Mat_<float> half(depth_m.rows / 2, depth_m.cols / 2);
  for_each_row(half.size(), [&](int v) {
    kernels.halve_depth_row(depth_m[2 * v], depth_m[2 * v + 1], max_depth_m, tolerance, half.cols,
                            half[v]);
  });
  return half;
}

SurfaceMap surface_from_depth(const cv::Mat_<float>& depth_m, const Intrinsics& intrinsics,
                              const SensorNoise& noise, const Kernels& kernels) {
  check_image_size("depth_m", depth_m.size(), intrinsics);
  return surface_of(depth_m.clone(), intrinsics, noise, false, kernels);
}

SurfacePyramid pyramid_from_depth(const cv::Mat_<float>& depth_m, const Intrinsics& intrinsics,
                                  int skip, int levels, float max_depth_m, const SensorNoise& noise,
                                  const Kernels& kernels) {
  check_image_size("depth_m", depth_m.size(), intrinsics);
  cv::Mat_<float> depth = depth_m;
  Intrinsics camera = intrinsics;
  if (skip == 0) {
    depth = depth_m.clone();
    depth.setTo(kNaN, depth > max_depth_m);
  }
  SurfacePyramid pyramid;
  for (int level = 0; level < skip + levels; ++level) {
    if (level > 0) {
      depth = half_size(depth, depth_tolerance(noise.local, camera), max_depth_m, kernels);
      camera = half_size(camera);
    }
    if (level < skip) continue;
    const bool smooth_normals = level - skip < kSmoothedLevels;
    pyramid.push_back(surface_of(depth, camera, noise, smooth_normals, kernels));
  }
  return pyramid;
}

SurfacePyramid pyramid_from_surface(SurfaceMap finest, int levels, const Kernels& kernels) {
  SurfacePyramid pyramid{std::move(finest)};
  while (static_cast<int>(pyramid.size()) < levels) {
    pyramid.push_back(half_size_surface(pyramid.back(), kernels));
  }
  return pyramid;
}

}  // namespace kintsugi::mapper

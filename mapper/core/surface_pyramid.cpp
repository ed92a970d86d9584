#include "mapper/core/surface_pyramid.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace kintsugi::mapper {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
const Eigen::Vector3f kInvalid = Eigen::Vector3f::Constant(kNaN);
constexpr float kSameSurface_m = 0.05F;  ///< pixels averaged by a halving lie this close
constexpr float kNormalReach_m = 0.10F;  ///< depth step across which no normal is taken
constexpr int kRowsPerTask = 16;

template <typename Row>
void for_each_row(int rows, const Row& row) {
  tbb::parallel_for(tbb::blocked_range<int>(0, rows, kRowsPerTask),
                    [&](const tbb::blocked_range<int>& range) {
                      for (int v = range.begin(); v != range.end(); ++v) row(v);
                    });
}

/// Mean of those of four depths that lie near the smallest; NaN if none is valid.
float mean_of_nearest(const float (&depths_m)[4]) {
  float nearest = std::numeric_limits<float>::infinity();
  for (const float z : depths_m) nearest = z < nearest ? z : nearest;
  float sum = 0.0F;
  int count = 0;
  for (const float z : depths_m) {
    if (z - nearest < kSameSurface_m) {
      sum += z;
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<float>(count) : kNaN;
}

/// Normal at the middle of four neighbours, towards the camera; NaN where they are no one surface.
Eigen::Vector3f normal_from_neighbours(const Eigen::Vector3f& left, const Eigen::Vector3f& right,
                                       const Eigen::Vector3f& above, const Eigen::Vector3f& below) {
  const Eigen::Vector3f du = right - left;
  const Eigen::Vector3f dv = below - above;
  // A NaN among the neighbours makes these comparisons false.
  if (!(std::abs(du.z()) < kNormalReach_m && std::abs(dv.z()) < kNormalReach_m)) return kInvalid;
  const Eigen::Vector3f n = dv.cross(du);  // v points down and u right: this looks at the camera
  const float length = n.norm();
  return length > 0.0F ? Eigen::Vector3f(n / length) : kInvalid;
}

SurfaceMap half_size_surface(const SurfaceMap& fine) {
  SurfaceMap half(half_size(fine.intrinsics));
  for_each_row(half.depth_m.rows, [&](int v) {
    for (int u = 0; u < half.depth_m.cols; ++u) {
      float depth_sum = 0.0F;
      Eigen::Vector3f normal_sum = Eigen::Vector3f::Zero();
      float first_z = kNaN;
      int count = 0;
      for (int k = 0; k < 4; ++k) {
        const float z = fine.depth_m(2 * v + k / 2, 2 * u + k % 2);
        const Eigen::Vector3f n = fine.normal(2 * v + k / 2, 2 * u + k % 2);
        if (std::isnan(z) || std::isnan(n.z())) continue;
        if (count == 0) first_z = z;
        if (std::abs(z - first_z) > kSameSurface_m) continue;
        depth_sum += z;
        normal_sum += n;
        ++count;
      }
      const float length = normal_sum.norm();
      const bool valid = count > 0 && length > 0.0F;
      half.depth_m(v, u) = valid ? depth_sum / static_cast<float>(count) : kNaN;
      half.set_normal(v, u, valid ? Eigen::Vector3f(normal_sum / length) : kInvalid);
    }
  });
  return half;
}

}  // namespace

Intrinsics half_size(const Intrinsics& intrinsics) {
  Intrinsics half = intrinsics;
  half.fx /= 2.0;
  half.fy /= 2.0;
  half.cx = (intrinsics.cx + 0.5) / 2.0 - 0.5;
  half.cy = (intrinsics.cy + 0.5) / 2.0 - 0.5;
  half.width /= 2;
  half.height /= 2;
  return half;
}

cv::Mat_<float> half_size(const cv::Mat_<float>& depth_m) {
  cv::Mat_<float> half(depth_m.rows / 2, depth_m.cols / 2);
  for_each_row(half.rows, [&](int v) {
    const float* upper = depth_m.ptr<float>(2 * v);
    const float* lower = depth_m.ptr<float>(2 * v + 1);
    for (int u = 0; u < half.cols; ++u) {
      const int left = 2 * u;
      half(v, u) = mean_of_nearest({upper[left], upper[left + 1], lower[left], lower[left + 1]});
    }
  });
  return half;
}

SurfaceMap surface_from_depth(const cv::Mat_<float>& depth_m, const Intrinsics& intrinsics) {
  if (depth_m.cols != intrinsics.width || depth_m.rows != intrinsics.height) {
    throw std::invalid_argument("depth image is " + std::to_string(depth_m.cols) + "x" +
                                std::to_string(depth_m.rows) + ", its intrinsics are for " +
                                std::to_string(intrinsics.width) + "x" +
                                std::to_string(intrinsics.height));
  }
  SurfaceMap surface(intrinsics);
  depth_m.copyTo(surface.depth_m);
  for_each_row(depth_m.rows, [&](int v) {
    const bool inside_v = v > 0 && v + 1 < depth_m.rows;
    for (int u = 0; u < depth_m.cols; ++u) {
      const bool inside = inside_v && u > 0 && u + 1 < depth_m.cols;
      surface.set_normal(
          v, u,
          inside && !std::isnan(depth_m(v, u))
              ? normal_from_neighbours(surface.point(v, u - 1), surface.point(v, u + 1),
                                       surface.point(v - 1, u), surface.point(v + 1, u))
              : kInvalid);
    }
  });
  return surface;
}

SurfacePyramid pyramid_from_depth(const cv::Mat_<float>& depth_m, const Intrinsics& intrinsics,
                                  int skip, int levels, float max_depth_m) {
  cv::Mat_<float> depth = depth_m.clone();
  depth.setTo(kNaN, depth > max_depth_m);
  Intrinsics camera = intrinsics;
  SurfacePyramid pyramid;
  for (int level = 0; level < skip + levels; ++level) {
    if (level > 0) {
      depth = half_size(depth);
      camera = half_size(camera);
    }
    if (level >= skip) pyramid.push_back(surface_from_depth(depth, camera));
  }
  return pyramid;
}

SurfacePyramid pyramid_from_surface(SurfaceMap finest, int levels) {
  SurfacePyramid pyramid{std::move(finest)};
  while (static_cast<int>(pyramid.size()) < levels)
    pyramid.push_back(half_size_surface(pyramid.back()));
  return pyramid;
}

}  // namespace kintsugi::mapper

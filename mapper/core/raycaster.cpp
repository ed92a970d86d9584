#include "mapper/core/raycaster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "mapper/core/camera_view.hpp"
#include "mapper/core/check.hpp"
#include "mapper/core/ray_marcher.hpp"
#include "mapper/core/ray_ranges.hpp"
#include "mapper/core/tsdf_sampler.hpp"
#include "mapper/core/tsdf_volume.hpp"

namespace kintsugi::mapper {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// The pixels of a depth image under those of another size of the same view.
class Guide {
 public:
  Guide(const cv::Mat_<float>& depth_m, const CameraView& view)
      : depth_m_(depth_m),
        columns_per_u_(static_cast<float>(depth_m.cols) / static_cast<float>(view.width)),
        rows_per_v_(static_cast<float>(depth_m.rows) / static_cast<float>(view.height)) {}

  /// Depth in metres; not positive (zero or NaN) where there is none.
  float at(int u, int v) const {
    if (depth_m_.empty()) return 0.0F;
    const auto column = static_cast<int>((static_cast<float>(u) + 0.5F) * columns_per_u_);
    const auto row = static_cast<int>((static_cast<float>(v) + 0.5F) * rows_per_v_);
    return depth_m_(std::min(row, depth_m_.rows - 1), std::min(column, depth_m_.cols - 1));
  }

 private:
  const cv::Mat_<float>& depth_m_;
  float columns_per_u_;
  float rows_per_v_;
};

/// Depth of the surface on a ray, searched from just before the guide first.
std::optional<float> cast_ray(RayMarcher& marcher, const RayRanges::Range& range,
                              float guide_depth_m, float guide_margin_m) {
  const float start_m = guide_depth_m - guide_margin_m;
  if (start_m > range.near_m && start_m < range.far_m) {
    if (const auto depth_m = marcher.find_surface(start_m, range.far_m)) return depth_m;
  }
  return marcher.find_surface(range.near_m, range.far_m);
}

/// From C, in metres, to cube coordinates.
class CubeFrame {
 public:
  CubeFrame(const TsdfVolume& volume, const Pose& X_WC) {
    const double resolution_m = volume.config().resolution_m;
    const BlockCoord& min = volume.min_block();
    const Eigen::Vector3d corner_vox = Eigen::Vector3d(min.x, min.y, min.z) * kBlockSide;
    origin_vox_ = (X_WC.translation() / resolution_m - corner_vox).cast<float>();
    vox_per_m_ = (X_WC.linear() / resolution_m).cast<float>();
  }
  Ray ray(const Eigen::Vector3f& ray_C) const {
    return {.origin_vox = origin_vox_, .direction_vox_per_m = vox_per_m_ * ray_C};
  }

 private:
  Eigen::Vector3f origin_vox_;
  Eigen::Matrix3f vox_per_m_;
};

Eigen::Vector3f normal_C(const std::optional<Eigen::Vector3f>& gradient_W, const CameraView& view,
                         const Eigen::Vector3f& ray_C) {
  const Eigen::Vector3f invalid = Eigen::Vector3f::Constant(kNaN);
  if (!gradient_W) return invalid;
  const Eigen::Vector3f normal = view.R_WC.transpose() * *gradient_W;
  if (!(normal.dot(ray_C) < 0.0F)) return invalid;  // also where the gradient is zero
  return normal.normalized();
}

SurfaceMap empty_surface(const Intrinsics& intrinsics) {
  SurfaceMap surface(intrinsics);
  for (cv::Mat* plane :
       {&surface.depth_m, &surface.normal_x, &surface.normal_y, &surface.normal_z}) {
    plane->setTo(kNaN);
  }
  return surface;
}

cv::Vec3b to_bytes(const Eigen::Vector3f& color) {
  const auto rounded = [&](int i) { return static_cast<unsigned char>(std::lround(color[i])); };
  return {rounded(0), rounded(1), rounded(2)};
}

}  // namespace

void Raycaster::Config::validate() const {
  check_range("min_depth_m", min_depth_m, 0.01, 100.0);
  check_range("max_depth_m", max_depth_m, min_depth_m, 100.0);
}

Raycaster::Raycaster(const Config& config) : config_(config) { config_.validate(); }

SurfaceMap Raycaster::raycast(const TsdfVolume& volume, const Pose& X_WC,
                              const Intrinsics& intrinsics, const cv::Mat_<float>& guide_depth_m,
                              cv::Mat_<cv::Vec3b>* color_rgb) const {
  const CameraView view(intrinsics, X_WC);
  const RayRanges ranges(volume, view, static_cast<float>(config_.min_depth_m),
                         static_cast<float>(config_.max_depth_m));
  const Guide guide(guide_depth_m, view);
  const CubeFrame cube(volume, X_WC);
  const float guide_margin_m = 2.0F * volume.truncation_m();

  SurfaceMap surface = empty_surface(intrinsics);
  if (color_rgb != nullptr) {
    *color_rgb = cv::Mat_<cv::Vec3b>(view.height, view.width, cv::Vec3b::all(0));
  }

  tbb::parallel_for(tbb::blocked_range<int>(0, view.height, 4), [&](const auto& rows) {
    TsdfSampler sampler(volume);
    for (int v = rows.begin(); v < rows.end(); ++v) {
      for (int u = 0; u < view.width; ++u) {
        const Eigen::Vector3f ray_C = view.ray_C(static_cast<float>(u), static_cast<float>(v));
        const Ray ray = cube.ray(ray_C);
        RayMarcher marcher(volume, ray, sampler);
        const std::optional<float> depth_m =
            cast_ray(marcher, ranges.at(u, v), guide.at(u, v), guide_margin_m);
        if (!depth_m) continue;
        const Eigen::Vector3f point_vox = ray.at(*depth_m);
        surface.depth_m(v, u) = *depth_m;
        surface.set_normal(v, u, normal_C(sampler.gradient(point_vox), view, ray_C));
        if (color_rgb != nullptr) (*color_rgb)(v, u) = to_bytes(sampler.color(point_vox));
      }
    }
  });
  return surface;
}

}  // namespace kintsugi::mapper

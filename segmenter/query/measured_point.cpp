#include "segmenter/query/measured_point.hpp"

#include <algorithm>
#include <cmath>

#include "segmenter/query/pixel_ray.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr double kLeastRadius_m = 0.03;
constexpr double kLeastRadius_vox = 2.0;

/// The number of the sample nearest to a pixel, of `count` along one axis.
int nearest_sample(double pixel, int step, int count) {
  const int first = step / 2;  // as CameraView has it
  const auto place = static_cast<int>(std::lround((pixel - first) / step));
  return std::clamp(place, 0, count - 1);
}

/// The pixel at which the sample was measured.
int pixel_of_sample(int place, int step) { return place * step + step / 2; }

}  // namespace

std::optional<MeasuredPoint> measured_sample(const CameraView& view, int i, int j) {
  const std::size_t place =
      static_cast<std::size_t>(j) * static_cast<std::size_t>(view.depth_width()) +
      static_cast<std::size_t>(i);
  const std::uint16_t depth_mm = view.depth_mm[place];
  if (depth_mm == 0) return std::nullopt;
  const Ray ray = pixel_ray(view.intrinsics, view.X_WC, pixel_of_sample(i, view.depth_step),
                            pixel_of_sample(j, view.depth_step));
  // Depth is along the camera's z.
  const double cosine = ray.direction_W.dot(view.X_WC.linear().col(2));
  return MeasuredPoint{ray, 1e-3 * depth_mm / cosine};
}

std::optional<MeasuredPoint> measured_point(const CameraView& view, double u_px, double v_px) {
  check_pixel(view.intrinsics, u_px, v_px);
  return measured_sample(view, nearest_sample(u_px, view.depth_step, view.depth_width()),
                         nearest_sample(v_px, view.depth_step, view.depth_height()));
}

double pixel_radius_m(double resolution_m) {
  return std::max(kLeastRadius_m, kLeastRadius_vox * resolution_m);
}

}  // namespace kintsugi::segmenter

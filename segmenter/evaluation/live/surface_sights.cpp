#include "segmenter/evaluation/live/surface_sights.hpp"

#include <algorithm>
#include <cmath>

#include "segmenter/query/measured_point.hpp"

namespace kintsugi::segmenter {

void SurfaceSights::add(const CameraView& view, double now_s) {
  views_.push_back({view, now_s});
  views_.back().view.color_jpeg = {};
}

bool SurfaceSights::is_in_sight(const CameraView& view, const Eigen::Vector3d& p_W) const {
  const Intrinsics& camera = view.intrinsics;
  const Eigen::Vector3d p_C = view.X_WC.inverse(Eigen::Isometry) * p_W;
  if (p_C.z() <= 0.0) return false;
  const double u_px = camera.fx * p_C.x() / p_C.z() + camera.cx;
  const double v_px = camera.fy * p_C.y() / p_C.z() + camera.cy;
  const bool is_in_image =
      u_px > -0.5 && u_px < camera.width - 0.5 && v_px > -0.5 && v_px < camera.height - 0.5;
  if (!is_in_image) return false;
  const auto measured = measured_point(view, u_px, v_px);
  return measured && std::abs(measured->distance_m - p_C.norm()) <= radius_m_;
}

std::optional<double> SurfaceSights::seen_s(const Eigen::Vector3d& p_W) const {
  std::int64_t num_frames = 0;
  bool was_in_sight = false;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const bool is_seen = is_in_sight(views_[i].view, p_W);
    if (is_seen) {
      num_frames += was_in_sight ? views_[i].view.frame_index - views_[i - 1].view.frame_index : 1;
      if (num_frames >= min_frames_) return views_[i].time_s;
    }
    was_in_sight = is_seen;
  }
  return std::nullopt;
}

}  // namespace kintsugi::segmenter

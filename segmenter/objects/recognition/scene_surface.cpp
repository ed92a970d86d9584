#include "segmenter/objects/recognition/scene_surface.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

namespace kintsugi::segmenter {

SceneSurface::SceneSurface(std::span<const CloudPoint> points_W,
                           std::span<const std::uint32_t> segment_ids, float spacing_m,
                           float within_m)
    : surface_W_(unthinned(points_W, spacing_m)),
      segment_ids_(segment_ids.begin(), segment_ids.end()),
      cell_m_(within_m) {
  build_cells();
}

SceneSurface::SceneSurface(Surface surface_W, float within_m)
    : surface_W_(std::move(surface_W)),
      segment_ids_(surface_W_.size(), kNoSegment),
      cell_m_(within_m) {
  build_cells();
}

void SceneSurface::build_cells() {
  if (surface_W_.empty()) return;
  Eigen::AlignedBox3f box;
  for (const SurfacePoint& point : surface_W_) box.extend(point.position);
  low_W_ = box.min();
  size_ = (box.sizes() / cell_m_).array().floor().cast<int>() + 1;
  first_.assign(static_cast<std::size_t>(size_.x()) * size_.y() * size_.z(), -1);
  next_.resize(surface_W_.size());
  for (std::size_t i = 0; i < surface_W_.size(); ++i) {
    std::int32_t& first = first_[index_of(cell_of(surface_W_[i].position))];
    next_[i] = first;
    first = static_cast<std::int32_t>(i);
  }
}

Eigen::Vector3i SceneSurface::cell_of(const Eigen::Vector3f& p_W) const {
  return ((p_W - low_W_) / cell_m_).array().floor().cast<int>();
}

std::size_t SceneSurface::index_of(const Eigen::Vector3i& cell) const {
  return (static_cast<std::size_t>(cell.z()) * size_.y() + cell.y()) * size_.x() + cell.x();
}

}  // namespace kintsugi::segmenter

#include "segmenter/objects/recognition/surface_grid.hpp"

#include <Eigen/Geometry>
#include <cstddef>
#include <utility>

#include "segmenter/objects/recognition/grid_cells.hpp"

namespace kintsugi::segmenter {

SurfaceGrid::SurfaceGrid(Surface surface, float cell_m) : surface_(std::move(surface)) {
  if (surface_.empty()) return;
  Eigen::AlignedBox3f box;
  for (const SurfacePoint& point : surface_) box.extend(point.position);
  low_ = box.min();
  inverse_cell_ = 1.0F / bounded_cell_m(cell_m, box.sizes(), kMaxCells);
  size_ = cell_of(box.max()) + Eigen::Vector3i::Ones();
  std::vector<std::size_t> cells;
  cells.reserve(surface_.size());
  first_.assign(static_cast<std::size_t>(size_.x()) * size_.y() * size_.z() + 1, 0);
  for (const SurfacePoint& point : surface_) {
    const Eigen::Vector3i cell = cell_of(point.position);
    cells.push_back(index_of(cell.x(), cell.y(), cell.z()));
    ++first_[cells.back() + 1];
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  entries_.resize(surface_.size());
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    entries_[static_cast<std::size_t>(next[cells[i]]++)] = {surface_[i].position,
                                                            static_cast<std::int32_t>(i)};
  }
}

}  // namespace kintsugi::segmenter

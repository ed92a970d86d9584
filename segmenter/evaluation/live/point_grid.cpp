#include "segmenter/evaluation/live/point_grid.hpp"

#include <unordered_set>

namespace kintsugi::segmenter {

void PointGrid::insert(const PlacedPoint& point) {
  cells_[cell_at(point.position_W(), cell_m_)].push_back(point);
}

void PointGrid::erase(std::int32_t slice_id, std::span<const CloudPoint> points_W) {
  std::unordered_set<CellKey, CellKeyHash> keys;
  for (const CloudPoint& point : points_W) {
    keys.insert(cell_at(Eigen::Vector3d(point.x, point.y, point.z), cell_m_));
  }
  for (const CellKey key : keys) {
    const auto cell = cells_.find(key);
    if (cell == cells_.end()) continue;  // the points have no segment
    std::erase_if(cell->second, [&](const PlacedPoint& p) { return p.slice_id == slice_id; });
    if (cell->second.empty()) cells_.erase(cell);
  }
}

bool PointGrid::has_point_within(const Eigen::Vector3d& p_W, double radius_m) const {
  bool is_found = false;
  visit_near(p_W, radius_m, [&](const PlacedPoint& point) {
    is_found = (point.position_W() - p_W).squaredNorm() <= radius_m * radius_m;
    return !is_found;
  });
  return is_found;
}

}  // namespace kintsugi::segmenter

#pragma once
// Finds the points of a changing map near a place.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/evaluation/live/cells.hpp"

namespace kintsugi::segmenter {

/// A point of the map: its position, and what identifies it.
struct PlacedPoint {
  float x = 0.0F;  ///< metres, W
  float y = 0.0F;
  float z = 0.0F;
  std::int32_t slice_id = 0;
  std::int32_t index = 0;  ///< in its slice

  Eigen::Vector3d position_W() const { return {x, y, z}; }
};

class PointGrid {
 public:
  /// @param cell_m about the radius that is looked for, > 0
  explicit PointGrid(double cell_m) : cell_m_(cell_m) {}

  double cell_m() const { return cell_m_; }
  void insert(const PlacedPoint& point);
  /// Removes all points of a slice, whose points are `points_W`.
  void erase(std::int32_t slice_id, std::span<const CloudPoint> points_W);

  /// Calls visit(point) for each point in the cells that the ball touches, until it returns false.
  template <class Visit>
  void visit_near(const Eigen::Vector3d& p_W, double radius_m, const Visit& visit) const {
    const auto low = [&](int axis) { return cell_of(p_W[axis] - radius_m, cell_m_); };
    const auto high = [&](int axis) { return cell_of(p_W[axis] + radius_m, cell_m_); };
    for (std::int64_t i = low(0); i <= high(0); ++i) {
      for (std::int64_t j = low(1); j <= high(1); ++j) {
        for (std::int64_t k = low(2); k <= high(2); ++k) {
          if (!visit_cell(cell_key(i, j, k), visit)) return;
        }
      }
    }
  }
  /// The same for one cell; false when `visit` has returned false.
  template <class Visit>
  bool visit_cell(CellKey key, const Visit& visit) const {
    const auto cell = cells_.find(key);
    if (cell == cells_.end()) return true;
    for (const PlacedPoint& point : cell->second) {
      if (!visit(point)) return false;
    }
    return true;
  }

  bool has_point_within(const Eigen::Vector3d& p_W, double radius_m) const;

 private:
  double cell_m_;
  std::unordered_map<CellKey, std::vector<PlacedPoint>, CellKeyHash> cells_;
};

}  // namespace kintsugi::segmenter

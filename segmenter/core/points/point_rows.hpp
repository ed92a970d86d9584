#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/base/growing_array.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {

/// Copies of points sorted into rows, for passes over all pairs of neighbours.
///
/// A row is a beam along x, one cell wide in y and z; a cell is slightly larger than r. The
/// neighbours of a point lie in its own row and the eight around it. Points in a row are sorted by
/// x. So while a pass goes along one row, the part of each other row that is within r in x is a
/// sliding window: no look-ups, and memory is read in order.
class PointRows {
 public:
  struct Point {
    float x, y, z;     ///< metres, W
    float nx, ny, nz;  ///< unit normal, W
    std::uint8_t red, green, blue;
    PointIndex index;  ///< in points_W
  };
  /// Index of a point in points().
  using Slot = std::uint32_t;

  /// `points` are indices into `points_W`, each once; `radius_m` > 0.
  PointRows(std::span<const CloudPoint> points_W, std::span<const PointIndex> points,
            float radius_m);
  PointRows(const PointCloud& cloud, std::span<const PointIndex> points, float radius_m)
      : PointRows(cloud.points_W(), points, radius_m) {}

  std::span<const Point> points() const { return points_.span(); }
  std::size_t num_rows() const { return rows_.size() - 1; }
  /// The cells of a row, in a grid of r * kCellsPerRadius, and the slots of its points.
  struct Row {
    std::int32_t z;
    std::int32_t y;
    Slot first;
    Slot last;  ///< one past it
  };
  Row row(std::size_t index) const {
    const RowStart& row = rows_[index];
    return {row.z, row.y, row.first, rows_[index + 1].first};
  }

  /// Calls fn(Slot a, Slot b) for each pair of neighbours whose first point, in the order of rows,
  /// lies in `row` and for which keep(a, b) holds. Over all rows, each pair comes once. May be
  /// called concurrently.
  template <typename Keep, typename Fn>
  void for_each_pair(std::size_t row, const Keep& keep, const Fn& fn) const;

 private:
  struct RowStart {
    std::int32_t z;
    std::int32_t y;
    Slot first;
  };
  /// The part of a row that is within r in x of the current point.
  struct Window {
    Slot begin = 0;
    Slot end = 0;
    Slot limit = 0;  ///< end of the row
  };

  /// The windows of `row` itself, first, and of the four rows after it that are adjacent to it.
  std::array<Window, 5> windows_of(std::size_t row) const;
  bool is_within_reach(float from_x, float to_x) const { return to_x - from_x < reach_m_; }
  void slide(Window& window, float x) const {
    while (window.begin < window.limit && !is_within_reach(points_[window.begin].x, x)) {
      ++window.begin;
    }
    window.end = std::max(window.end, window.begin);
    while (window.end < window.limit && is_within_reach(x, points_[window.end].x)) ++window.end;
  }
  std::size_t find_row(std::int32_t z, std::int32_t y) const;

  float squared_radius_m2_;
  float reach_m_;
  GrowingArray<Point> points_;
  std::vector<RowStart> rows_;  ///< by z, then y; a sentinel at the end
};

template <typename Keep, typename Fn>
void PointRows::for_each_pair(std::size_t row, const Keep& keep, const Fn& fn) const {
  std::array<Window, 5> windows = windows_of(row);
  std::vector<Slot> near;
  for (Slot a = rows_[row].first; a < rows_[row + 1].first; ++a) {
    const Point& p = points_[a];
    std::size_t num_candidates = 0;
    windows[0].begin = a + 1;
    for (Window& window : windows) {
      slide(window, p.x);
      num_candidates += window.end - window.begin;
    }
    if (near.size() < num_candidates) near.resize(2 * num_candidates);

    std::size_t num_near = 0;
    for (const Window& window : windows) {
      for (Slot b = window.begin; b < window.end; ++b) {
        if (!keep(a, b)) continue;
        const float dx = p.x - points_[b].x;
        const float dy = p.y - points_[b].y;
        const float dz = p.z - points_[b].z;
        // The order of operations of squared_distance(). No branch, which could not be predicted.
        near[num_near] = b;
        num_near += static_cast<std::size_t>((dx * dx + dy * dy) + dz * dz < squared_radius_m2_);
      }
    }
    for (std::size_t k = 0; k < num_near; ++k) fn(a, near[k]);
  }
}

}  // namespace kintsugi::segmenter

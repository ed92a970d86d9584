#pragma once
// The points of a surface, found by place.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "segmenter/objects/recognition/surface.hpp"

namespace kintsugi::segmenter {

/// A point of a surface, and how far it is from the place that was asked for.
struct NearestPoint {
  std::int32_t index = -1;  ///< -1: there is none
  float squared_m2 = 0.0F;
};

class SurfaceGrid {
 public:
  SurfaceGrid() = default;
  /// @param cell_m side of a cell, > 0; searches are quickest within about as much. It is enlarged
  ///   where the grid would have more than kMaxCells cells
  SurfaceGrid(Surface surface, float cell_m);

  [[nodiscard]] const Surface& surface() const { return surface_; }

  static constexpr std::int64_t kMaxCells = 4'000'000;  ///< 16 MB

  /// The nearest point that is at most `within_m` from `p` and wanted.
  template <class IsWanted>
  [[nodiscard]] NearestPoint nearest(const Eigen::Vector3f& p, float within_m,
                                     const IsWanted& is_wanted) const;

 private:
  [[nodiscard]] Eigen::Vector3i cell_of(const Eigen::Vector3f& p) const {
    return ((p - low_) * inverse_cell_).array().floor().cast<int>();
  }
  [[nodiscard]] std::size_t index_of(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * size_.y() + y) * size_.x() + x;
  }

  // Beside each other, since searches look at them all and at few other things of a point.
  struct Entry {
    Eigen::Vector3f position;
    std::int32_t index;
  };

  Surface surface_;
  float inverse_cell_ = 1.0F;
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero();
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<std::int32_t> first_;  // in entries_, of each cell and one more
  std::vector<Entry> entries_;       // by cell
};

/// Normals of the same face (kSameNormal): at an edge the nearest point may be on another one.
inline auto facing(const Eigen::Vector3f& normal) {
  return [&normal](const SurfacePoint& point) { return point.normal.dot(normal) >= kSameNormal; };
}

inline bool any_point(const SurfacePoint& /*point*/) { return true; }

template <class IsWanted>
NearestPoint SurfaceGrid::nearest(const Eigen::Vector3f& p, float within_m,
                                  const IsWanted& is_wanted) const {
  NearestPoint nearest{-1, within_m * within_m};
  if (surface_.empty()) return nearest;
  const Eigen::Vector3f reach = Eigen::Vector3f::Constant(within_m);
  const Eigen::Vector3i low = cell_of(p - reach).cwiseMax(0);
  const Eigen::Vector3i high = cell_of(p + reach).cwiseMin(size_ - Eigen::Vector3i::Ones());
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      if (low.x() > high.x()) continue;
      // The cells along x follow each other.
      const std::int32_t end = first_[index_of(high.x(), y, z) + 1];
      for (std::int32_t k = first_[index_of(low.x(), y, z)]; k < end; ++k) {
        const Entry& entry = entries_[static_cast<std::size_t>(k)];
        const float squared = (entry.position - p).squaredNorm();
        if (squared > nearest.squared_m2) continue;
        // Of points as near as each other the last one, whatever the cells.
        if (squared == nearest.squared_m2 && entry.index < nearest.index) continue;
        if (is_wanted(surface_[static_cast<std::size_t>(entry.index)])) {
          nearest = {entry.index, squared};
        }
      }
    }
  }
  return nearest;
}

}  // namespace kintsugi::segmenter

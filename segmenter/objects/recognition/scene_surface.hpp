#pragma once
// A part of a map in which an object may be.

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/objects/recognition/surface.hpp"

namespace kintsugi::segmenter {

/// Points of the map with their segments, found by place.
class SceneSurface {
 public:
  /// @param segment_ids of each point
  /// @param spacing_m of the points
  /// @param within_m the distance of nearest(), > 0
  SceneSurface(std::span<const CloudPoint> points_W, std::span<const std::uint32_t> segment_ids,
               float spacing_m, float within_m);

  /// Of a surface of which nothing is known of segments.
  SceneSurface(Surface surface_W, float within_m);

  [[nodiscard]] const Surface& surface_W() const { return surface_W_; }
  [[nodiscard]] const std::vector<std::uint32_t>& segment_ids() const { return segment_ids_; }

  /// The nearest point that is at most `within_m` from `p_W`; nullptr: there is none.
  [[nodiscard]] const SurfacePoint* nearest(const Eigen::Vector3f& p_W) const {
    return nearest(p_W, [](const SurfacePoint&) { return true; });
  }
  /// The same of those that face nearly the way of `normal_W` (kSameNormal): at an edge the nearest
  /// may be on the other face. nullptr: there is none.
  [[nodiscard]] const SurfacePoint* nearest_facing(const Eigen::Vector3f& p_W,
                                                   const Eigen::Vector3f& normal_W) const {
    return nearest(p_W, [&normal_W](const SurfacePoint& point) {
      return point.normal.dot(normal_W) >= kSameNormal;
    });
  }

 private:
  template <class IsWanted>
  const SurfacePoint* nearest(const Eigen::Vector3f& p_W, const IsWanted& is_wanted) const;
  void build_cells();
  [[nodiscard]] Eigen::Vector3i cell_of(const Eigen::Vector3f& p_W) const;
  [[nodiscard]] std::size_t index_of(const Eigen::Vector3i& cell) const;

  Surface surface_W_;
  std::vector<std::uint32_t> segment_ids_;
  float cell_m_;
  Eigen::Vector3f low_W_ = Eigen::Vector3f::Zero();
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<std::int32_t> first_;  // of the points in each cell; -1: none
  std::vector<std::int32_t> next_;   // by point
};

template <class IsWanted>
const SurfacePoint* SceneSurface::nearest(const Eigen::Vector3f& p_W,
                                          const IsWanted& is_wanted) const {
  if (surface_W_.empty()) return nullptr;
  const Eigen::Vector3i cell = cell_of(p_W);
  const Eigen::Vector3i low = (cell.array() - 1).max(0);
  const Eigen::Vector3i high = (cell.array() + 1).min(size_.array() - 1);
  const SurfacePoint* nearest = nullptr;
  float least = cell_m_ * cell_m_;
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) {
        for (std::int32_t i = first_[index_of({x, y, z})]; i >= 0;
             i = next_[static_cast<std::size_t>(i)]) {
          const SurfacePoint& point = surface_W_[static_cast<std::size_t>(i)];
          const float squared = (point.position - p_W).squaredNorm();
          if (squared > least || !is_wanted(point)) continue;
          least = squared;
          nearest = &point;
        }
      }
    }
  }
  return nearest;
}

}  // namespace kintsugi::segmenter

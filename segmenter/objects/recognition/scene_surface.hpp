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

  [[nodiscard]] const Surface& surface_W() const { return surface_W_; }
  [[nodiscard]] const std::vector<std::uint32_t>& segment_ids() const { return segment_ids_; }

  /// The nearest point that is at most `within_m` from `p_W`; nullptr: there is none.
  [[nodiscard]] const SurfacePoint* nearest(const Eigen::Vector3f& p_W) const;

  /// The points of these segments, which are given in ascending order.
  [[nodiscard]] Surface of_segments(std::span<const std::uint32_t> ids) const;

 private:
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

}  // namespace kintsugi::segmenter

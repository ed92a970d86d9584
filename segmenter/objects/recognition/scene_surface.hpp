#pragma once
// A part of a map in which objects are looked for.

#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/objects/recognition/surface.hpp"
#include "segmenter/objects/recognition/surface_field.hpp"

namespace kintsugi::segmenter {

class SceneSurface {
 public:
  /// Points without a normal are left out. The result does not depend on the order of the points.
  /// @param segment_ids of each point
  /// @param resolution_m voxel size of the map, > 0
  SceneSurface(std::span<const CloudPoint> points_W, std::span<const std::uint32_t> segment_ids,
               float resolution_m);

  [[nodiscard]] const Surface& surface_W() const { return surface_W_; }
  [[nodiscard]] const std::vector<std::uint32_t>& segment_ids() const { return segment_ids_; }
  [[nodiscard]] const SurfaceField& field() const { return field_; }
  [[nodiscard]] float resolution_m() const { return resolution_m_; }

  /// The points of these segments, which are given in ascending order.
  [[nodiscard]] Surface of_segments(std::span<const std::uint32_t> ids) const;

 private:
  Surface surface_W_;
  std::vector<std::uint32_t> segment_ids_;
  float resolution_m_;
  SurfaceField field_;
};

}  // namespace kintsugi::segmenter

#pragma once
// A map as recognition sees it.

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "segmenter/objects/recognition/agreement.hpp"
#include "segmenter/objects/recognition/labelled_map.hpp"
#include "segmenter/objects/recognition/scene_surface.hpp"
#include "segmenter/objects/recognition/surface.hpp"
#include "segmenter/objects/recognition/view_descriptor.hpp"
#include "segmenter/views/observed_space.hpp"

namespace kintsugi::segmenter {

/// Touching segments that may together be one object: their ids, ascending.
using Candidate = std::vector<std::uint32_t>;

/// Keeps what it has computed of segments and places until they change. Not to be used by two
/// threads at once.
class Scene {
 public:
  /// @param resolution_m voxel size of the map, > 0
  explicit Scene(float resolution_m);
  Scene(const Scene&) = delete;  // its parts refer to each other
  Scene& operator=(const Scene&) = delete;

  /// As LabelledMap::set_piece(); returns the segments that lost or gained points.
  std::set<std::uint32_t> set_piece(std::int32_t id, LabelledMap::Points points_W,
                                    std::vector<std::uint32_t> segment_ids);
  /// The light that falls on all of the map, beside that of the library: colours are compared as if
  /// it did not. None at first.
  void set_light(const LightChange& light);
  [[nodiscard]] const LightChange& light() const { return light_; }
  /// What the cameras saw, which must outlive this; nullptr: that is not known.
  void set_observed(const ObservedSpace* observed) { observed_ = observed; }

  [[nodiscard]] float resolution_m() const { return resolution_m_; }
  [[nodiscard]] const LabelledMap& map() const { return map_; }
  [[nodiscard]] const SceneSurface& surface() const { return surface_; }
  [[nodiscard]] const ObservedSpace* observed() const { return observed_; }

  /// The surface of segments, thinned to `resolution_m`.
  [[nodiscard]] Surface surface_W(std::span<const std::uint32_t> segments) const;
  /// The beginning of the description of segments as one surface (view_descriptor()).
  [[nodiscard]] SizeAndColors size_and_colors(std::span<const std::uint32_t> segments) const;
  /// The mean of the shape features of their points. Each segment has its own, without what
  /// touches it.
  [[nodiscard]] ShapeFeature shape(std::span<const std::uint32_t> segments) const;

 private:
  struct SegmentSurface {
    Surface surface_W;
    Surface described_W;                // thinned further
    std::optional<ShapeFeature> shape;  // mean
  };

  [[nodiscard]] SegmentSurface& segment(std::uint32_t id) const;

  float resolution_m_;
  LabelledMap map_;
  SceneSurface surface_;
  LightChange light_;
  const ObservedSpace* observed_ = nullptr;
  mutable std::map<std::uint32_t, SegmentSurface> segments_;  // those that were asked for
};

}  // namespace kintsugi::segmenter

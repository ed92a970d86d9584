#pragma once
// A map as recognition sees it.

#include <cstdint>
#include <mutex>
#include <set>
#include <span>
#include <vector>

#include <oneapi/tbb/concurrent_unordered_map.h>

#include "segmenter/objects/recognition/agreement.hpp"
#include "segmenter/objects/recognition/labelled_map.hpp"
#include "segmenter/objects/recognition/scene_surface.hpp"
#include "segmenter/objects/recognition/segment_borders.hpp"
#include "segmenter/objects/recognition/surface.hpp"
#include "segmenter/objects/recognition/surface_moments.hpp"
#include "segmenter/objects/recognition/view_descriptor.hpp"
#include "segmenter/views/observed_space.hpp"

namespace kintsugi::segmenter {

/// Touching segments that may together be one object: their ids, ascending.
using Candidate = std::vector<std::uint32_t>;

/// Keeps what it has computed of segments and places until they change. Several threads may ask it
/// at once, while nobody changes it; they get what one thread would get.
class Scene {
 public:
  /// @param resolution_m voxel size of the map, > 0
  explicit Scene(float resolution_m);
  Scene(const Scene&) = delete;  // its parts refer to each other
  Scene& operator=(const Scene&) = delete;

  /// As LabelledMap::set_piece(); returns the segments that have changed.
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
  /// The direction that is up in W.
  [[nodiscard]] Eigen::Vector3d up_W() const;
  [[nodiscard]] const ObservedSpace* observed() const { return observed_; }

  /// The segments that touch a segment: points closer than two voxels, as in the engine's defaults.
  [[nodiscard]] const std::vector<SegmentNeighbour>& neighbours_of(std::uint32_t segment) const {
    return borders_.neighbours_of(segment);
  }
  /// The surface of segments, thinned to `resolution_m`.
  [[nodiscard]] Surface surface_W(std::span<const std::uint32_t> segments) const;
  /// Of their surface as it is described: thinned to described_spacing_m().
  [[nodiscard]] SurfaceMoments moments(std::span<const std::uint32_t> segments) const;
  /// About the same, in a small part of the time where the surface is not known yet.
  [[nodiscard]] SurfaceMoments rough_moments(std::span<const std::uint32_t> segments) const;
  /// The mean of the shape features of their points. Each segment has its own, without what
  /// touches it.
  [[nodiscard]] ShapeFeature shape(std::span<const std::uint32_t> segments) const;

 private:
  struct SegmentSurface {
    Surface surface_W;
    Surface described_W;     // thinned further
    SurfaceMoments moments;  // of that
  };

  [[nodiscard]] const SegmentSurface& segment(std::uint32_t id) const;
  [[nodiscard]] const SurfaceMoments& rough_moments_of(std::uint32_t id) const;
  /// Mean over its points, of which there must be some.
  [[nodiscard]] const ShapeFeature& shape_of(std::uint32_t id) const;

  float resolution_m_;
  LabelledMap map_;
  mutable std::mutex up_mutex_;  // the map computes that when it is asked
  SceneSurface surface_;
  SegmentBorders borders_;
  LightChange light_;
  const ObservedSpace* observed_ = nullptr;
  // Of those that were asked for.
  mutable oneapi::tbb::concurrent_unordered_map<std::uint32_t, SegmentSurface> segments_;
  mutable oneapi::tbb::concurrent_unordered_map<std::uint32_t, SurfaceMoments> rough_moments_;
  mutable oneapi::tbb::concurrent_unordered_map<std::uint32_t, ShapeFeature> shapes_;
};

}  // namespace kintsugi::segmenter

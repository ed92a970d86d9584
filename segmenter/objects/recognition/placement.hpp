#pragma once
// Whether an object is really where it could be.

#include <cstdint>
#include <set>
#include <vector>

#include "segmenter/objects/recognition/pose_hypothesis.hpp"
#include "segmenter/objects/recognition/prepared_model.hpp"
#include "segmenter/objects/recognition/scene.hpp"

namespace kintsugi::segmenter {

/// An object at a place of the map, and what speaks for and against it.
struct Placement {
  Pose X_WO = Pose::Identity();
  LightChange light;
  /// Share of the model's surface that is in the map there.
  float seen = 0.0F;
  /// Share of the model's surface that is not in the map, although the camera saw that place: it is
  /// free, or another surface is there; by half, where another surface is so near in front of it
  /// that the object would reach into it or touch it.
  float contradicted = 0.0F;
  /// Share of the points of `segment_ids` that are surface of the object, without those that are
  /// on its surface in another colour: `contradicted` has these.
  float explained = 0.0F;
  /// Share of the map's points that are surface of the object that belong to `segment_ids`.
  float own = 0.0F;
  /// How well `light` agrees with that of the map, from 0 to 1; see SceneLight.
  float light_agreement = 1.0F;
  /// What is seen of it is more than one flat patch of one colour, which many things have.
  bool is_distinct = false;
  std::int32_t points = 0;  ///< of the map that are surface of the object
  /// In CIELAB: length of the mean difference of colour between `points` and the model in `light`.
  float color_difference = 0.0F;
  std::vector<std::uint32_t> segment_ids;  ///< most of whose points are; ascending

  /// From 0 to 1: how much of all that is to be seen of model and segments agrees.
  [[nodiscard]] float score() const;
};

/// With this score and more an object is said to be there.
inline constexpr float kLeastScore = 0.6F;

/// What is there of the object in the pose of the hypothesis.
/// Where what the camera saw is not known, what is not in the map speaks against the object by
/// half.
Placement placement_of(const PreparedModel& model, const Scene& scene,
                       const PoseHypothesis& hypothesis);

/// The segments that have points in the box of the object there.
std::set<std::uint32_t> segments_around(const PreparedModel& model, const Scene& scene,
                                        const Pose& X_WO);

}  // namespace kintsugi::segmenter

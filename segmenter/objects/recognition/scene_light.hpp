#pragma once
// The light of a place, by which all things in it look different at once.

#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "segmenter/objects/recognition/agreement.hpp"
#include "segmenter/objects/recognition/object_recognizer.hpp"

namespace kintsugi::segmenter {

/// What the light of a map changes of all colours beside those of the library, and how sure that
/// is. Things stand brighter or darker, in the shadow or near a lamp, but the light of a place has
/// one colour. As long as the light is not known it may be any that is allowed at all.
struct SceneLight {
  Eigen::Vector3f log_gain = Eigen::Vector3f::Zero();  ///< as LightChange::log_gain
  /// Standard deviation of that of a single thing.
  float brightness_deviation = LightChange::kMaxBrightness;
  /// The same between channels: one may have more of the largest tint, and another one less.
  float tint_deviation = std::numbers::sqrt2_v<float> * LightChange::kMaxTint;
  float likelihood = 1.0F;  ///< of this light itself, from 0 to 1

  [[nodiscard]] static SceneLight known(const LightChange& light);

  /// From 0 to 1: how well the light that a placement assumes agrees.
  [[nodiscard]] float agreement(const LightChange& light) const;
};

/// So few objects, or places of one object, that agree tell a light: two that are wrong may agree
/// by chance.
inline constexpr std::size_t kFewestThatTellLight = 3;

/// The lights in which objects stand that were taught in other maps.
class SceneLights {
 public:
  /// @param recognitions by descending score
  explicit SceneLights(std::vector<Recognition> recognitions);

  /// That of the place, on which kFewestThatTellLight objects or more agree. Each object speaks
  /// once for a light, by the best place that it has there: in the dark much looks like one white
  /// thing, and all of that in one light.
  [[nodiscard]] const std::optional<SceneLight>& of_most_objects() const { return of_most_; }

  /// That in which one object stands: of_most_objects(), or else that in which most speaks for the
  /// object itself. There is none where fewer than kFewestThatTellLight places speak for it: then
  /// it may be any.
  [[nodiscard]] SceneLight of(std::size_t model) const;

 private:
  std::vector<Recognition> recognitions_;
  std::optional<SceneLight> of_most_;
};

}  // namespace kintsugi::segmenter

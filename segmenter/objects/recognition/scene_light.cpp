#include "segmenter/objects/recognition/scene_light.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

namespace kintsugi::segmenter {

namespace {

// Of logarithms. Brightness: shadows and exposure. Tint: light from coloured walls, and the
// camera's white balance.
constexpr float kBrightnessDeviation = 0.3F;
constexpr float kTintDeviation = 0.2F;

// More is not told apart from noise.
constexpr float kHighestScore = 0.98F;

/// Weighted mean of lights.
class MeanLight {
 public:
  void add(const LightChange& light, float weight) {
    sum_ += weight * light.log_gain;
    weight_ += weight;
    ++count_;
  }
  [[nodiscard]] float weight() const { return weight_; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] LightChange mean() const { return {sum_ / weight_}; }

 private:
  Eigen::Vector3f sum_ = Eigen::Vector3f::Zero();
  float weight_ = 0.0F;
  std::size_t count_ = 0;
};

bool are_near(const LightChange& a, const LightChange& b) {
  return (a.log_gain - b.log_gain).norm() <= kBrightnessDeviation;
}

/// By object: the score of the best place that it has in nearly this light, and the light there.
std::map<std::size_t, std::pair<float, LightChange>> best_near(
    const LightChange& light, std::span<const Recognition> recognitions) {
  const SceneLight middle = SceneLight::known(light);
  std::map<std::size_t, std::pair<float, LightChange>> best_of;
  for (const auto& [model, placement, searched_points] : recognitions) {
    if (!are_near(placement.light, light)) continue;
    const float score = placement.score() * middle.agreement(placement.light);
    auto& best = best_of[model];
    if (score > best.first) best = {score, placement.light};
  }
  return best_of;
}

std::optional<SceneLight> light_of_most_objects(std::span<const Recognition> recognitions) {
  std::optional<SceneLight> light;
  float most = 0.0F;
  for (const Recognition& middle : recognitions) {
    MeanLight near;
    for (const auto& [model, best] : best_near(middle.placement.light, recognitions)) {
      near.add(best.second, best.first);
    }
    if (near.count() < kFewestThatTellLight || near.weight() <= most) continue;
    most = near.weight();
    light = SceneLight::known(near.mean());
  }
  return light;
}

/// One place where an object fits perfectly says more than some where half of it fits.
float odds_of(float score) {
  const float bounded = std::min(score, kHighestScore);
  return bounded / (1.0F - bounded);
}

/// @param places of one object
std::optional<SceneLight> light_of_most_places(std::span<const Recognition* const> places) {
  const SceneLight any;
  std::optional<SceneLight> light;
  float most = 0.0F;
  for (const Recognition* const middle : places) {
    const SceneLight known = SceneLight::known(middle->placement.light);
    MeanLight near;
    for (const Recognition* const place : places) {
      const Placement& placement = place->placement;
      if (!are_near(placement.light, middle->placement.light)) continue;
      near.add(placement.light, odds_of(placement.score() * known.agreement(placement.light) *
                                        any.agreement(placement.light)));
    }
    if (near.weight() <= most) continue;
    most = near.weight();
    light.reset();
    if (near.count() < kFewestThatTellLight) continue;
    light = SceneLight::known(near.mean());
    light->likelihood = any.agreement(near.mean());
  }
  return light;
}

}  // namespace

SceneLight SceneLight::known(const LightChange& light) {
  return {.log_gain = light.log_gain,
          .brightness_deviation = kBrightnessDeviation,
          .tint_deviation = kTintDeviation};
}

float SceneLight::agreement(const LightChange& light) const {
  const Eigen::Vector3f difference = light.log_gain - log_gain;
  const float brightness = difference.mean() / brightness_deviation;
  const float tint = (difference.array() - difference.mean()).matrix().norm() / tint_deviation;
  return likelihood * std::exp(-(brightness * brightness + tint * tint) / 2);
}

SceneLights::SceneLights(std::vector<Recognition> recognitions)
    : recognitions_(std::move(recognitions)), of_most_(light_of_most_objects(recognitions_)) {}

SceneLight SceneLights::of(std::size_t model) const {
  if (of_most_) return *of_most_;
  std::vector<const Recognition*> places;
  for (const Recognition& recognition : recognitions_) {
    if (recognition.model == model) places.push_back(&recognition);
  }
  return light_of_most_places(places).value_or(SceneLight());
}

}  // namespace kintsugi::segmenter

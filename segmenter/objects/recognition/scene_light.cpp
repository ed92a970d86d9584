#include "segmenter/objects/recognition/scene_light.hpp"

#include <cmath>
#include <cstddef>

namespace kintsugi::segmenter {

namespace {

// Of logarithms. Brightness: shadows and exposure. Tint: light from coloured walls, and the
// camera's white balance.
constexpr float kBrightnessDeviation = 0.3F;
constexpr float kTintDeviation = 0.2F;
constexpr std::size_t kFewest = 3;  // two wrong ones may agree by chance

}  // namespace

float SceneLight::agreement(const LightChange& light) const {
  const Eigen::Vector3f difference = light.log_gain - log_gain;
  const float brightness = difference.mean() / brightness_deviation;
  const float tint = (difference.array() - difference.mean()).matrix().norm() / tint_deviation;
  return std::exp(-(brightness * brightness + tint * tint) / 2);
}

SceneLight light_of_scene(std::span<const Placement* const> placements) {
  SceneLight scene;
  float most = 0.0F;
  for (const Placement* middle : placements) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float weight = 0.0F;
    std::size_t count = 0;
    for (const Placement* other : placements) {
      if ((other->light.log_gain - middle->light.log_gain).norm() > kBrightnessDeviation) continue;
      sum += other->score() * other->light.log_gain;
      weight += other->score();
      ++count;
    }
    if (count < kFewest || weight <= most) continue;
    most = weight;
    scene.log_gain = sum / weight;
    scene.is_known = true;
    scene.brightness_deviation = kBrightnessDeviation;
    scene.tint_deviation = kTintDeviation;
  }
  return scene;
}

}  // namespace kintsugi::segmenter

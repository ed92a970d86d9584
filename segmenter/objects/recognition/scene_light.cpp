#include "segmenter/objects/recognition/scene_light.hpp"

#include <cmath>
#include <cstddef>

namespace kintsugi::segmenter {

namespace {

constexpr float kKnownDeviation = 0.3F;  // of logarithms: 30 %
constexpr std::size_t kFewest = 3;       // two wrong ones may agree by chance

}  // namespace

float SceneLight::agreement(const LightChange& light) const {
  return std::exp(-(light.log_gain - log_gain).squaredNorm() / (2 * deviation * deviation));
}

SceneLight light_of_scene(std::span<const Placement* const> placements) {
  SceneLight scene;
  float most = 0.0F;
  for (const Placement* middle : placements) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float weight = 0.0F;
    std::size_t count = 0;
    for (const Placement* other : placements) {
      if ((other->light.log_gain - middle->light.log_gain).norm() > kKnownDeviation) continue;
      sum += other->score() * other->light.log_gain;
      weight += other->score();
      ++count;
    }
    if (count < kFewest || weight <= most) continue;
    most = weight;
    scene.log_gain = sum / weight;
    scene.deviation = kKnownDeviation;
  }
  return scene;
}

}  // namespace kintsugi::segmenter

#include "segmenter/objects/changes/alike_colors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kintsugi::segmenter {

float color_distance(const SurfacePoint& a, const SurfacePoint& b) {
  // exp(-0.4) to exp(0.4): what walls and things around reflect differs from place to place.
  constexpr std::array kShades = {1.0F, 0.82F, 1.22F, 0.67F, 1.49F};
  float least = std::numeric_limits<float>::infinity();
  for (const float shade : kShades) {
    least = std::min(least, (lab_of(shade * a.rgb) - b.lab).squaredNorm());
  }
  return std::sqrt(least);
}

bool are_alike_in_color(const SurfacePoint& a, const SurfacePoint& b, float within) {
  return !a.has_color || !b.has_color || color_distance(a, b) <= within;
}

}  // namespace kintsugi::segmenter

#include "segmenter/objects/changes/alike_colors.hpp"

#include <algorithm>
#include <array>

#include "segmenter/objects/recognition/agreement.hpp"

namespace kintsugi::segmenter {

bool are_alike_in_color(const SurfacePoint& a, const SurfacePoint& b) {
  if (!a.has_color || !b.has_color) return true;
  // exp(-0.4) to exp(0.4): what walls and things around reflect differs from place to place.
  constexpr std::array kShades = {1.0F, 0.82F, 1.22F, 0.67F, 1.49F};
  return std::ranges::any_of(kShades, [&](float shade) {
    return (lab_of(shade * a.rgb) - b.lab).squaredNorm() <= kSameColor * kSameColor;
  });
}

}  // namespace kintsugi::segmenter

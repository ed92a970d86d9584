#include "viewer/core/drawing/palette.hpp"

#include <algorithm>
#include <cmath>

namespace kintsugi::viewer {
namespace {

/// One channel of an HSV colour (Smith 1978): offset 5 for red, 3 for green, 1 for blue.
std::uint8_t hsv_channel(double offset, double hue, double saturation, double value) {
  const double k = std::fmod(offset + 6.0 * hue, 6.0);
  const double ramp = std::clamp(std::min(k, 4.0 - k), 0.0, 1.0);
  return static_cast<std::uint8_t>(std::lround(255.0 * value * (1.0 - saturation * ramp)));
}

}  // namespace

Rgb segment_color(std::uint32_t segment_id) {
  if (segment_id == kNoSegment) return palette::kUnlabelledPoint;
  // Multiples of the golden ratio modulo 1 keep any run of ids evenly apart on the hue circle; a
  // second irrational step spreads the same hues over light and saturation.
  constexpr double kHueStep = 0.618033988749895;
  constexpr double kToneStep = 0.754877666246693;
  const double hue = std::fmod(segment_id * kHueStep, 1.0);
  const double tone = std::fmod(segment_id * kToneStep, 1.0);
  const double saturation = 0.45 + 0.45 * tone;
  const double value = 1.0 - 0.3 * std::fmod(2.0 * tone, 1.0);
  return {.red = hsv_channel(5.0, hue, saturation, value),
          .green = hsv_channel(3.0, hue, saturation, value),
          .blue = hsv_channel(1.0, hue, saturation, value)};
}

}  // namespace kintsugi::viewer

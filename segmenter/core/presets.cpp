#include "segmenter/core/presets.hpp"

#include <array>
#include <stdexcept>
#include <string>

namespace kintsugi::segmenter {
namespace {

constexpr std::array<std::string_view, 2> kNames = {"objects", "paper"};

}  // namespace

std::span<const std::string_view> preset_names() { return kNames; }

EngineConfig preset(std::string_view name) {
  EngineConfig config;
  if (name == "paper") return config;
  if (name == "objects") {
    config.scale = 0.002;
    config.color_weight = 0.003;
    config.min_points = 50.0;
    return config;
  }
  std::string known;
  for (const std::string_view other : kNames) known.append(" ").append(other);
  throw std::invalid_argument("preset is \"" + std::string(name) + "\", must be one of:" + known);
}

}  // namespace kintsugi::segmenter

#include "segmenter/core/parameters/presets.hpp"

#include <array>

#include "lcmtypes/base/choice_check.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::array<std::string_view, 2> kNames = {"objects", "paper"};

void set_objects(EngineConfig& config, std::span<const EngineParameter> parameters) {
  for (const EngineParameter& parameter : parameters) {
    config.*parameter.value = parameter.objects.value_or(config.*parameter.value);
  }
}

}  // namespace

std::span<const std::string_view> preset_names() { return kNames; }

EngineConfig preset(std::string_view name) {
  require_one_of("preset", name, kNames);
  EngineConfig config;
  if (name == "paper") return config;
  set_objects(config, kMapParameters);
  set_objects(config, kSpeedParameters);
  return config;
}

}  // namespace kintsugi::segmenter

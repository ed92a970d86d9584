#include "segmenter/core/parameters/engine_config.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::segmenter {
namespace {

void check_bounds(const EngineConfig& config, std::span<const EngineParameter> parameters) {
  for (const EngineParameter& parameter : parameters) {
    const double value = config.*parameter.value;
    require(parameter.bound.holds(value), parameter.name, value, parameter.bound.text);
  }
}

}  // namespace

std::int64_t EngineConfig::fragment_limit() const {
  constexpr double kReferenceResolution_m = 0.01;
  const double scale_per_axis = kReferenceResolution_m / resolution_m;
  return std::llround(min_points * scale_per_axis * scale_per_axis);
}

void EngineConfig::validate() const {
  check_bounds(*this, kMapParameters);
  check_bounds(*this, kSpeedParameters);
  // Every squared distance would be on the same side of a square that vanishes or overflows.
  require(std::isnormal(radius_m() * radius_m()), "radius_factor * resolution_m",
          radius_factor * resolution_m, "a radius whose square is a normal float32");
}

std::string option_name(const EngineParameter& parameter) {
  std::string name = "--" + std::string(parameter.name);
  std::ranges::replace(name, '_', '-');
  return name;
}

}  // namespace kintsugi::segmenter

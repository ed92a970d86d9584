#include "segmenter/evaluation/comparison/parameter_sets.hpp"

#include <spdlog/fmt/fmt.h>

namespace kintsugi::segmenter {

std::span<const SweptParameter> swept_parameters() {
  static const std::vector<SweptParameter> parameters = {
      {"threshold", &EngineConfig::threshold, {0.25, 0.5, 2.0, 4.0}},
      {"scale", &EngineConfig::scale, {0.25, 0.5, 0.75, 1.5, 2.0, 4.0}},
      {"color_weight", &EngineConfig::color_weight, {0.0, 0.25, 0.5, 0.75, 1.5, 2.0, 4.0}},
      {"min_points", &EngineConfig::min_points, {0.0, 0.25, 0.5, 0.75, 1.5, 2.0, 4.0}},
      {"radius_factor", &EngineConfig::radius_factor, {0.75, 1.25, 1.5}}};
  return parameters;
}

std::vector<ParameterSet> sweep_around(const EngineConfig& base) {
  std::vector<ParameterSet> variants;
  for (const SweptParameter& parameter : swept_parameters()) {
    for (const double factor : parameter.factors) {
      ParameterSet& variant = variants.emplace_back();
      variant.name = fmt::format("{} x {:g}", parameter.name, factor);
      variant.engine = base;
      variant.engine.*parameter.value *= factor;
      variant.parameter = parameter.name;
      variant.factor = factor;
    }
  }
  return variants;
}

}  // namespace kintsugi::segmenter

#pragma once

#include <vector>

#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter::testing {

/// The default config with one parameter changed to another valid value.
struct ChangedParameter {
  EngineParameter parameter;
  EngineConfig config;
};

/// One for each of kMapParameters.
inline std::vector<ChangedParameter> changed_parameters() {
  std::vector<ChangedParameter> changed;
  for (const EngineParameter& parameter : kMapParameters) {
    EngineConfig config;
    double& value = config.*parameter.value;
    value = 1.1 * value + 0.001;
    config.validate();
    changed.push_back({parameter, config});
  }
  return changed;
}

}  // namespace kintsugi::segmenter::testing

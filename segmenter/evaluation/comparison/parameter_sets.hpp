#pragma once
// The parameters whose quality is compared.

#include <span>
#include <string>
#include <vector>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter {

struct ParameterSet {
  std::string name;  ///< of a preset, or as `scale x 2`
  EngineConfig engine;
  std::string parameter;  ///< that differs from the preset; "": none
  double factor = 1.0;    ///< it is the preset's times this
};

/// A parameter that a sweep varies.
struct SweptParameter {
  std::string name;  ///< as its flag has it, with _
  double EngineConfig::*value;
  std::vector<double> factors;  ///< of the value that the preset has, ascending, 1 left out
};

/// threshold, scale, color_weight, min_points and radius_factor.
std::span<const SweptParameter> swept_parameters();

/// `base` with one parameter at a time at each of its factors, in the order of swept_parameters().
std::vector<ParameterSet> sweep_around(const EngineConfig& base);

}  // namespace kintsugi::segmenter

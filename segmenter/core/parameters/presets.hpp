#pragma once
// Named sets of parameters.

#include <span>
#include <string_view>

#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter {

/// The names preset() knows; the first is the default of all programs.
std::span<const std::string_view> preset_names();

/// The parameters of a preset:
///   objects  colour counts and fragments are joined, so that monitors, books and cups come out
///            whole
///   paper    those of Finman et al. 2014: Eq. 2 alone, fragments stay
/// @throws std::invalid_argument for an unknown name, naming those there are
EngineConfig preset(std::string_view name);

}  // namespace kintsugi::segmenter

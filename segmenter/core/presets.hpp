#pragma once
// Sets of parameters that have a name.

#include <span>
#include <string_view>

#include "segmenter/core/engine/engine.hpp"

namespace kintsugi::segmenter {

/// The names preset() knows; the first is what programs use unless told otherwise.
std::span<const std::string_view> preset_names();

/// Throws std::invalid_argument for an unknown name, naming those there are.
///   objects  monitors, books and cups come out whole: colour counts, and fragments are joined
///   paper    the parameters of Finman et al. 2014: Eq. 2 alone, no last step
EngineConfig preset(std::string_view name);

}  // namespace kintsugi::segmenter

#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter {

/// The modes make_engine() knows; the first is the default of all programs.
std::span<const std::string_view> engine_modes();

/// @throws std::invalid_argument for an unknown mode (naming those there are), an invalid config,
///   or an audit of a mode whose result need not equal batch
void check_mode(std::string_view mode, const EngineConfig& config);

/// Makes the engine called `mode` over `cloud`, which must outlive it.
/// @throws std::invalid_argument as check_mode()
std::unique_ptr<SegmentationEngine> make_engine(std::string_view mode, const PointCloud& cloud,
                                                const EngineConfig& config);

}  // namespace kintsugi::segmenter

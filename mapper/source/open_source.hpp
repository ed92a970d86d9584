#pragma once

#include <memory>

#include "mapper/source/frames/frame_source.hpp"
#include "mapper/source/frames/source_config.hpp"

namespace kintsugi::mapper {

/// Opens the source that `config.device` names. The one place that knows every kind of source.
/// @throws std::invalid_argument for a bad configuration, std::runtime_error with the file or
///   device and the reason when it cannot be opened or is empty
std::unique_ptr<FrameSource> open_frame_source(const SourceConfig& config);

}  // namespace kintsugi::mapper

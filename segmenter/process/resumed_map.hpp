#pragma once
// A map that was saved by an earlier run.

#include <cstdint>
#include <filesystem>
#include <memory>

#include "segmenter/map/segment_map.hpp"

namespace kintsugi::segmenter {

/// The map in `file`, to be continued under `config` as segmenter session `session`.
/// @throws std::runtime_error naming the file when it is no saved map, or was saved with another
///   mode or another of kMapParameters
std::unique_ptr<SegmentMap> resume_map(const std::filesystem::path& file,
                                       const SegmentMapConfig& config, std::int64_t session);

}  // namespace kintsugi::segmenter

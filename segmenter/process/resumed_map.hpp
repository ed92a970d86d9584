#pragma once
// A map that was saved by an earlier run.

#include <cstdint>
#include <filesystem>
#include <memory>

#include "segmenter/map/segment_map.hpp"

namespace kintsugi::segmenter {

/// The map in `file`, to be gone on with under `config` as segmenter session `session`. Throws
/// std::runtime_error naming the file when it is no saved map, or one of another mode or of other
/// parameters; those that decide on time alone may differ.
std::unique_ptr<SegmentMap> resume_map(const std::filesystem::path& file,
                                       const SegmentMapConfig& config, std::int64_t session);

}  // namespace kintsugi::segmenter

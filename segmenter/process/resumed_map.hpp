#pragma once
// A map that was saved by an earlier run.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "segmenter/map/segment_map.hpp"
#include "segmenter/process/view_recorder.hpp"

namespace kintsugi::segmenter {

/// The map in `file`, to be continued under `config` as segmenter session `session`.
/// @param map_name that it must have; empty: any
/// @throws std::runtime_error naming the file when it is no saved map, has another name, or was
///   saved with another mode or another of kMapParameters
std::unique_ptr<SegmentMap> resume_map(const std::filesystem::path& file,
                                       const SegmentMapConfig& config, const std::string& map_name,
                                       std::int64_t session);

/// Goes on with the views beside the saved map `file`, of which `map` was made. Without them, or
/// where they are of another session, which a kill between two files can leave, new ones are kept;
/// that is told.
/// @throws std::runtime_error naming the file of views when it is damaged or no such file
void resume_views(const std::filesystem::path& file, const SegmentMap& map, ViewRecorder& recorder);

}  // namespace kintsugi::segmenter

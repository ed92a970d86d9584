#pragma once

#include <filesystem>

#include "segmenter/evaluation/session/recorded_session.hpp"
#include "segmenter/io/cloud_input.hpp"

namespace kintsugi::segmenter {

/// Reads a PLY file (read_cloud()): its points by slice_id, without it as a single slice. Has
/// neither times nor a path.
/// @throws std::runtime_error as read_cloud()
RecordedSession read_session_cloud(const std::filesystem::path& path,
                                   const CloudInputConfig& config);

}  // namespace kintsugi::segmenter

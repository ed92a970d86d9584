#pragma once
// Reads a session from a PLY file.

#include <filesystem>

#include "segmenter/evaluation/session/recorded_session.hpp"
#include "segmenter/io/cloud_input.hpp"

namespace kintsugi::segmenter {

/// Reads a PLY file (read_cloud()). Its slice_id gives the slices; without slice_id there is one.
/// The session has neither times nor a camera path.
/// @throws std::runtime_error as read_cloud()
RecordedSession read_session_cloud(const std::filesystem::path& path,
                                   const CloudInputConfig& config);

}  // namespace kintsugi::segmenter

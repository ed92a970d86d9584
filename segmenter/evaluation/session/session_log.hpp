#pragma once
// Reads a recorded session from an LCM log.

#include <filesystem>

#include "segmenter/evaluation/session/recorded_session.hpp"

namespace kintsugi::segmenter {

/// Reads CLOUD_SLICE and CAMERA_POSE from an LCM log, in any order of arrival and with duplicates.
/// Slices and corrections are ordered as in kintsugi-segmenter (SliceSequencer). Of several
/// sessions the one with most slices is used, of equal ones the first. Of a damaged log, what can
/// be read is used, and is_whole is false.
/// @throws std::runtime_error when `path` cannot be read, is no LCM log or holds no points
RecordedSession read_session_log(const std::filesystem::path& path);

}  // namespace kintsugi::segmenter

#pragma once

#include <filesystem>

#include "segmenter/evaluation/session/recorded_session.hpp"

namespace kintsugi::segmenter {

/// Reads CLOUD_SLICE and CAMERA_POSE from an LCM log, in any order of arrival and
/// with duplicates. Slices and corrections are put in order as kintsugi-segmenter does
/// (SliceSequencer). Of several sessions the one with most slices is taken, of equal ones the
/// first. What can be read of a damaged log is taken; is_whole tells.
/// @throws std::runtime_error when `path` cannot be read, is no LCM log or holds no points
RecordedSession read_session_log(const std::filesystem::path& path);

}  // namespace kintsugi::segmenter

#pragma once
// kintsugi-evaluate --live: how much of what the camera sees is in the segment map, and how soon.

#include <filesystem>

namespace kintsugi::segmenter {

/// Evaluates a log of everything that was on the bus, prints a table on stdout, and writes
/// `json_file` unless it is empty. Returns the exit status: 1 when the log is damaged.
/// @throws std::runtime_error as evaluate_live_log(), and for a file that cannot be written
int evaluate_live(const std::filesystem::path& log, const std::filesystem::path& json_file);

}  // namespace kintsugi::segmenter

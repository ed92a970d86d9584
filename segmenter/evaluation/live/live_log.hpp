#pragma once
// Evaluates the log of everything that was on the bus during a run.

#include <filesystem>
#include <string>
#include <vector>

#include "segmenter/evaluation/live/live_evaluation.hpp"

namespace kintsugi::segmenter {

struct LiveLogReport {
  std::string source;  ///< the file
  LiveReport report;
  std::vector<std::string> remarks;  ///< what a reader of the results must know
  bool is_whole = true;              ///< false: the log is damaged or lacks messages
};

/// Reads CLOUD_SLICE, SEGMENT_UPDATE and CAMERA_VIEW from a log of the bus, in the order and with
/// the times in which they were recorded. Of several sessions the one with most views is used.
/// @throws std::runtime_error when `path` cannot be read, is no LCM log, or has no views, or no
///   slices or updates of the session with most views
LiveLogReport evaluate_live_log(const std::filesystem::path& path, const LiveConfig& config);

}  // namespace kintsugi::segmenter

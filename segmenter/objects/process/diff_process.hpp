#pragma once
// Follows a map on the bus and says how it differs from an earlier one.

#include <filesystem>
#include <string>

#include "segmenter/views/observed_map.hpp"

namespace kintsugi::segmenter {

struct DiffProcessOptions {
  std::filesystem::path out;  ///< folder of the changes; written after each comparison
  std::string map_name;       ///< empty: the map of the first segment update that is received
  std::string lcm_url;        ///< of the bus; empty: LCM_DEFAULT_URL
  double every_s = 30.0;      ///< between the beginnings of comparisons, > 0
  bool exit_on_final = false;
};

/// Compares the map on the bus with `before` again and again, publishes CHANGE_REPORT and writes
/// the changes into the folder. Until a stop signal, or with `exit_on_final` until the final update
/// is compared. What the camera saw before this began is not known, and counts as not seen.
/// @return the exit code
/// @throws std::runtime_error when the bus cannot be opened, or, with `exit_on_final`, when the
///   complete map does not fit `before`
int run_diff(const ObservedMap& before, const DiffProcessOptions& options);

}  // namespace kintsugi::segmenter

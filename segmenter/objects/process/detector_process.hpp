#pragma once
// The fourth process: follows a map on the bus and publishes the objects in it.

#include <filesystem>
#include <string>

namespace kintsugi::segmenter {

struct DetectorOptions {
  std::filesystem::path library = "objects";
  std::string map_name;    ///< empty: the map of the first segment update that is received
  std::string lcm_url;     ///< of the bus; empty: LCM_DEFAULT_URL
  double cpu_share = 0.1;  ///< of one core, on average, while the map grows
  bool exit_on_final = false;
  std::filesystem::path json;  ///< written at the end; empty: nothing is
};

/// Runs until a stop signal, or with `exit_on_final` until the final update is examined.
/// @return the exit code
/// @throws std::runtime_error when library or bus cannot be opened
int run_detector(const DetectorOptions& options);

}  // namespace kintsugi::segmenter

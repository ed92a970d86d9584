#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "viewer/process/viewer.hpp"

namespace kintsugi::viewer {

/// The command line of kintsugi-viewer.
struct Options {
  std::string lcm_url;  ///< empty: LCM's default
  std::optional<std::filesystem::path> log;
  std::string map_name;       ///< draw only the map with this name; empty: the first that is heard
  double max_queue_mb = 256;  ///< received and not yet used
  bool exit_on_final = false;
  Viewer::Config viewer;

  std::size_t max_queue_bytes() const { return static_cast<std::size_t>(1e6 * max_queue_mb); }
};

/// Reads flags and --config FILE. Nothing when there is nothing to run, because help or the
/// configuration was asked for and printed, or something was wrong: then `exit_code` is not 0 and
/// standard error says what.
std::optional<Options> parse_options(int argc, char** argv, int& exit_code);

}  // namespace kintsugi::viewer

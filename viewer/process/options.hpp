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
  bool exit_on_final = false;
  Viewer::Config viewer;
};

/// Reads flags and --config FILE. Nothing when there is nothing to run, because help or the
/// configuration was asked for and printed, or something was wrong: then `exit_code` is not 0 and
/// standard error says what.
std::optional<Options> parse_options(int argc, char** argv, int& exit_code);

}  // namespace kintsugi::viewer

#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "viewer/process/viewer_process.hpp"
#include "viewer/web/web_view.hpp"

namespace kintsugi::viewer {

/// Everything that the command line of kintsugi-viewer sets.
struct Options {
  std::string lcm_url;                       ///< empty: LCM's default
  std::optional<std::filesystem::path> log;  ///< read this LCM log instead of the bus
  std::string map_name;                      ///< of the map to draw; empty: the first one received
  double max_queue_mb = 256;  ///< memory for messages received and not yet used, 1e6 bytes
  bool exit_on_final = false;
  ViewerProcess::Config process;
  std::optional<WebView::Config> web;  ///< nothing: no browser is served

  std::size_t max_queue_bytes() const { return static_cast<std::size_t>(1e6 * max_queue_mb); }
};

/// Reads the command line and the --config file that it names. Returns the options, or the exit
/// code when there is nothing to run: after --help, --print-config or a flag that cannot be parsed,
/// which is reported on stderr.
/// @throws std::invalid_argument for a value that is out of its bounds
std::variant<Options, int> parse_options(int argc, const char* const* argv);

}  // namespace kintsugi::viewer

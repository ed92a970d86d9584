#pragma once

#include "viewer/process/options.hpp"

namespace kintsugi::viewer {

/// Runs the viewer until SIGINT or SIGTERM, the end of the log, or the final pictures if
/// options.exit_on_final; SIGUSR1 writes a snapshot. Returns the exit code: 0, or 1 when a file
/// could not be written or the log is damaged.
/// @throws std::runtime_error or std::system_error when the bus, the log or an output cannot be
///   opened
int run(const Options& options);

}  // namespace kintsugi::viewer

#pragma once

#include "viewer/process/options.hpp"

namespace kintsugi::viewer {

/// Runs the viewer on the bus or a log until a signal, the end of the log, or the final picture if
/// so asked. Returns the exit code: 0, or 1 when a file could not be written or the log is damaged.
/// Throws when the bus, the log or an output cannot be opened.
int run(const Options& options);

}  // namespace kintsugi::viewer

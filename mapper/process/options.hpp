#pragma once

#include <variant>

#include "mapper/process/option_table.hpp"
#include "mapper/session/mapping_options.hpp"

namespace kintsugi::mapper {

/// The options that must match when a session is resumed. `options` as parse_options() returns
/// them.
MappingOptions mapping_options(const Options& options);

/// Reads the command line, the --config file, and the camera path that the options name. Returns
/// the options, or an exit code when there is nothing to run: after --help, --print-config,
/// --list-devices, --probe, or a wrong flag, which is reported on stderr.
/// @throws std::invalid_argument for a value out of its bounds, std::runtime_error for a file that
///   cannot be read
std::variant<Options, int> parse_options(int argc, const char* const* argv);

}  // namespace kintsugi::mapper

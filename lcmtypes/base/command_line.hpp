#pragma once
// What the command lines of all programs have in common.

#include <string>

namespace CLI {
class App;
}

namespace kintsugi {

/// Adds --version, which prints "PROGRAM MAJOR.MINOR.PATCH" and ends the parsing with exit code 0.
void add_version_flag(CLI::App& app);

/// Adds --config FILE: options as KEY = VALUE, in the format of --print-config; flags override
/// them. A key that is no option of the program is an error, which names the file, the key, and the
/// option that is spelt alike, if there is one.
void add_config_flag(CLI::App& app, const std::string& help);

}  // namespace kintsugi

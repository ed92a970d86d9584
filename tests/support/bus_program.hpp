#pragma once
// What the programs in this folder share: parsing flags, stopping on a signal, a report as JSON.

#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/signing/process_key.hpp"

namespace kintsugi::testing {

/// The main() of a program: parses the flags into Options, calls run() and prints its exception.
template <class Options>
int run_bus_program(int argc, char** argv, const std::string& description,
                    void (*add_flags)(CLI::App& app, Options& options),
                    void (*run)(const Options& options)) {
  CLI::App app(description);
  Options options;
  add_flags(app, options);
  add_bus_key_flag(app);
  CLI11_PARSE(app, argc, argv);
  install_stop_signals();
  try {
    run(options);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", *argv, error.what());
    return 1;
  }
}

/// Prints a report, and writes it to `file` unless that is empty.
/// @throws std::runtime_error when it cannot be written
inline void give_report(const nlohmann::json& report, const std::string& file) {
  const std::string text = report.dump(2);
  std::puts(text.c_str());
  if (!file.empty() && !(std::ofstream(file) << text << '\n')) {
    throw std::runtime_error("cannot write " + file);
  }
}

}  // namespace kintsugi::testing

// kintsugi-complete-log: makes sure that lcm-logger records all of a map.

#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/signing/process_key.hpp"
#include "lcmtypes/tools/log_completion.hpp"

namespace kintsugi {
namespace {

constexpr std::chrono::milliseconds kPeriod(50);
/// After the stop signal: in this time each sender tells twice what it has sent, and lcm-logger has
/// written it.
constexpr double kLastWords_s = 0.6;
constexpr int kIncomplete = 2;  // exit status

struct Options {
  std::string url;
  std::string log;
};

/// Null: it cannot be read yet, since lcm-logger has not begun it, or nothing in it is signed.
std::unique_ptr<LogCompletion> opened(const std::string& log) {
  try {
    return std::make_unique<LogCompletion>(log);
  } catch (const std::runtime_error&) {
    return nullptr;
  }
}

/// Until it is told to stop, and then as long as something is missing and comes. A second stop
/// signal ends it at once.
int follow(const Options& options) {
  Bus bus(options.url);
  PatientClock clock;
  std::unique_ptr<LogCompletion> log;
  std::optional<double> told_s;
  LogCompletion::Missing missing;
  while (true) {
    if (!log) log = opened(options.log);
    const double now_s = clock.now_s();
    if (log) {
      log->read_on();
      log->ask(bus, now_s);
      missing = log->missing();
    }
    if (stop_requested()) {
      if (told_s) break;
      told_s = now_s;
      rearm_stop_signals();
    }
    const bool is_all_known = told_s && now_s >= *told_s + kLastWords_s;
    if (is_all_known && missing.chunks == missing.given_up) break;
    std::this_thread::sleep_for(kPeriod);
  }
  if (!log) log = std::make_unique<LogCompletion>(options.log);  // says why it cannot be read
  const std::string damage = log->damage();
  if (!damage.empty()) std::cerr << "kintsugi-complete-log: " << damage << '\n';
  if (missing.chunks > 0) {
    std::cerr << "kintsugi-complete-log: " << options.log << " lacks " << missing.chunks
              << " chunks that were sent, and nobody sends them again\n";
  }
  return missing.chunks > 0 || !damage.empty() ? kIncomplete : 0;
}

}  // namespace
}  // namespace kintsugi

int main(int argc, char** argv) {
  return kintsugi::run_main(argv, [&] {
    CLI::App app(
        "Follows a log that lcm-logger writes, and asks on the bus for what lcm-logger has missed "
        "of slices, segment updates and keyframes: it is sent again, and lcm-logger hears it. "
        "After SIGINT or SIGTERM it stays until nothing is missing, or nobody answers for 5 s.");
    kintsugi::Options options;
    app.add_option("LOG", options.log, "the log; it may not exist yet")->required()->type_name("");
    app.add_option("--lcm-url", options.url,
                   "URL of the bus; default: LCM_DEFAULT_URL, or multicast on this host");
    kintsugi::add_bus_key_flag(app);
    kintsugi::add_version_flag(app);
    CLI11_PARSE(app, argc, argv);
    kintsugi::install_stop_signals();
    return kintsugi::follow(options);
  });
}

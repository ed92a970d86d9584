// kintsugi-status: shows the progress of a run, and tells a script when the run has finished.

#include <cstdio>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <sys/ioctl.h>
#include <unistd.h>

#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/number_range.hpp"
#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/bus/message_subscriber.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/signing/process_key.hpp"
#include "lcmtypes/tools/progress.hpp"
#include "lcmtypes/tools/status_log.hpp"

namespace kintsugi {
namespace {

constexpr int kNoProgress = 2;     // exit status
constexpr int kInterrupted = 130;  // the exit status that shells use

struct Options {
  std::string url;
  std::string map_name;
  bool once = false;
  bool until_finished = false;
  OptionalProcesses waited;
  std::vector<std::string> until_ready;
  bool lingering = false;
  std::string log_file;
  double log_period_s = 0.0;
  double timeout_s = 60.0;
};

/// A process that has not received any map yet has no map name.
bool is_of(const std::string& map_name, const std::string& name_in_status) {
  return map_name.empty() || name_in_status.empty() || name_in_status == map_name;
}

std::int64_t now_us(PatientClock& clock) { return static_cast<std::int64_t>(1e6 * clock.now_s()); }

void subscribe_statuses(Bus& bus, const std::string& map_name, PatientClock& clock,
                        Progress& progress, std::optional<StatusLog>& log) {
  const auto keep = [&](const auto& status) {
    progress.update(status, now_us(clock));
    if (log && is_of(map_name, status.map_name)) log->append(status);
  };
  subscribe<MapperStatus>(bus, channels::kMapperStatus, keep);
  subscribe<SegmenterStatus>(bus, channels::kSegmenterStatus, keep);
  subscribe<ViewerStatus>(bus, channels::kViewerStatus, keep);
  subscribe<DetectorStatus>(bus, channels::kDetectorStatus, keep);
}

/// Prints lines: in a terminal each line replaces the one before, elsewhere they follow each other.
class LinePrinter {
 public:
  LinePrinter() : in_terminal_(isatty(STDOUT_FILENO) == 1) {}
  ~LinePrinter() { end_line(); }
  LinePrinter(const LinePrinter&) = delete;
  LinePrinter& operator=(const LinePrinter&) = delete;

  void print(const std::string& line) {
    if (in_terminal_) {
      std::cout << '\r' << line.substr(0, width()) << "\x1b[K" << std::flush;
    } else {
      std::cout << line << std::endl;
    }
    line_open_ = in_terminal_;
  }

  /// Before anything else is written to the terminal.
  void end_line() {
    if (line_open_) std::cout << std::endl;
    line_open_ = false;
  }

 private:
  static std::size_t width() {
    winsize size{};
    const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
    return known ? size.ws_col - 1U : std::string::npos;
  }

  const bool in_terminal_;
  bool line_open_ = false;
};

int watch(const Options& options) {
  Bus bus(options.url);
  PatientClock clock;
  Progress progress(options.map_name);
  std::optional<StatusLog> log;
  if (!options.log_file.empty()) log.emplace(options.log_file, options.log_period_s);
  subscribe_statuses(bus, options.map_name, clock, progress, log);
  LinePrinter printer;
  double next_line_s = 1.0;
  const bool has_timeout = options.timeout_s > 0.0 && (options.once || options.until_finished);
  while (!stop_requested()) {
    bus.handle(std::chrono::milliseconds(100));
    const bool finished = options.until_finished && progress.finished(options.waited);
    const double now_s = clock.now_s();
    if (finished || now_s >= next_line_s) {
      if (!options.once || progress.heard_anything()) printer.print(progress.line(now_us(clock)));
      if (finished || (options.once && progress.heard_anything())) return 0;
      next_line_s = now_s + 1.0;
    }
    const double progress_s = 1e-6 * static_cast<double>(progress.last_progress_us().value_or(0));
    if (has_timeout && now_s - progress_s >= options.timeout_s) {
      printer.end_line();
      std::cerr << "kintsugi-status: no progress for " << options.timeout_s
                << " s: " << progress.unfinished(options.waited) << std::endl;
      return kNoProgress;
    }
  }
  return options.once || options.until_finished ? kInterrupted : 0;
}

template <class Status>
bool is_lingering(const Status& status) {
  if constexpr (requires { status.lingering; }) return status.lingering;
  return true;
}

/// Waits until each of the named processes has sent a status.
int wait_until_ready(const Options& options) {
  Bus bus(options.url);
  std::vector<std::string> silent = options.until_ready;
  const auto heard = [&silent, &options](const char* name) {
    return [&silent, &options, name](const auto& status) {
      if (!is_of(options.map_name, status.map_name)) return;
      if (!options.lingering || is_lingering(status)) std::erase(silent, name);
    };
  };
  subscribe<MapperStatus>(bus, channels::kMapperStatus, heard(MapperStatus::kProcess));
  subscribe<SegmenterStatus>(bus, channels::kSegmenterStatus, heard(SegmenterStatus::kProcess));
  subscribe<ViewerStatus>(bus, channels::kViewerStatus, heard(ViewerStatus::kProcess));
  subscribe<DetectorStatus>(bus, channels::kDetectorStatus, heard(DetectorStatus::kProcess));
  PatientClock clock;
  while (!stop_requested()) {
    if (silent.empty()) return 0;
    if (options.timeout_s > 0.0 && clock.now_s() >= options.timeout_s) {
      std::cerr << "kintsugi-status: no status received from the " << silent.front() << " in "
                << options.timeout_s << " s" << std::endl;
      return kNoProgress;
    }
    bus.handle(std::chrono::milliseconds(100));
  }
  return kInterrupted;
}

}  // namespace
}  // namespace kintsugi

int main(int argc, char** argv) {
  return kintsugi::run_main(argv, [&] {
    kintsugi::Options options;
    CLI::App app(
        "Shows the progress of mapper, segmenter, viewer and detector, one line a second.");
    app.add_option("--lcm-url", options.url,
                   "URL of the bus; default: LCM_DEFAULT_URL, or multicast on this host");
    kintsugi::add_bus_key_flag(app);
    app.add_option("--map-name", options.map_name,
                   "Watch the map with this name (default: the first that is received)");
    auto* once = app.add_flag("--once", options.once, "Print one line and exit");
    auto* until_finished =
        app.add_flag("--until-finished", options.until_finished,
                     "Exit 0 when mapper and segmenter have finished, 2 without progress")
            ->excludes(once);
    app.add_flag("--viewer", options.waited.viewer, "Wait for the viewer too")
        ->needs(until_finished);
    app.add_flag("--detector", options.waited.detector, "Wait for the detector of objects too")
        ->needs(until_finished);
    auto* until_ready =
        app.add_option(
               "--until-ready", options.until_ready,
               "Exit 0 when each of these has sent a status: mapper, segmenter, viewer, detector")
            ->delimiter(',')
            ->check(CLI::IsMember({"mapper", "segmenter", "viewer", "detector"}))
            ->excludes(once)
            ->excludes(until_finished);
    auto* log = app.add_option("--log", options.log_file,
                               "Append every field of every status to this CSV file")
                    ->excludes(until_ready);
    app.add_option(
           "--log-every", options.log_period_s,
           "With --log: of each process one status in so many seconds, and the last; 0: all")
        ->check(kintsugi::number_range(0, 1e9))
        ->needs(log)
        ->capture_default_str();
    app.add_flag("--lingering", options.lingering,
                 "With --until-ready: and has published everything")
        ->needs(until_ready);
    auto* timeout =
        app.add_option(
               "--timeout", options.timeout_s,
               "With --once, --until-finished or --until-ready: seconds without progress until "
               "giving up; 0: never")
            ->check(kintsugi::number_range(0, 1e9))
            ->capture_default_str();
    app.callback([=] {
      if (timeout->count() == 0 ||
          once->count() + until_finished->count() + until_ready->count() > 0)
        return;
      throw CLI::RequiresError("--timeout", "--once, --until-finished or --until-ready");
    });
    kintsugi::add_version_flag(app);
    CLI11_PARSE(app, argc, argv);
    kintsugi::install_stop_signals();
    return options.until_ready.empty() ? kintsugi::watch(options)
                                       : kintsugi::wait_until_ready(options);
  });
}

// kintsugi-segment-events: prints how the segments of a map and the known objects in it change over
// time, from the bus or a log. An example of a client of the segmenter.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iostream>
#include <string>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/output_files.hpp"
#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/client/object_listener.hpp"
#include "lcmtypes/client/object_text.hpp"
#include "lcmtypes/client/segment_listener.hpp"
#include "lcmtypes/client/segment_table_text.hpp"
#include "lcmtypes/log/whole_log_reader.hpp"
#include "lcmtypes/signing/process_key.hpp"

namespace kintsugi {
namespace {

struct Options {
  std::string url;
  std::string log;
  std::string map_name;
  bool exit_on_final = false;
  bool grown = false;
  bool quiet = false;
  std::size_t num_listed = 20;
  std::string json_file;
};

/// Prints a message to standard error, unless it is empty.
void say(const std::string& text) {
  if (!text.empty()) std::cerr << "kintsugi-segment-events: " << text << '\n';
}

/// Receives until a stop signal, or the end of the map.
void listen(SegmentListener& listener, ObjectListener& objects, const Options& options) {
  constexpr std::chrono::milliseconds kTickPeriod(20);
  Bus bus(options.url);
  PatientClock clock;
  listener.subscribe(bus);
  objects.subscribe(bus, [&clock] { return clock.now_s(); });
  say("listening on " + bus.url());
  double next_tick_s = 0.0;
  while (!stop_requested()) {
    bus.handle(kTickPeriod);
    const double now_s = clock.now_s();
    if (now_s < next_tick_s) continue;
    next_tick_s = now_s + std::chrono::duration<double>(kTickPeriod).count();
    listener.ask(bus, now_s);
    if (options.exit_on_final && listener.has_ended()) return;
  }
}

/// Reads the log up to its end or first damage, which it reports. False: it was not read to its
/// end.
bool read_log(SegmentListener& listener, ObjectListener& objects, const std::string& path) {
  WholeLogReader log(path);
  double now_s = 0.0;  // may not go back, as the clock of a computer may
  while (const auto event = log.next()) {
    if (stop_requested()) {
      say("interrupted: the rest of the log was not read");
      return false;
    }
    listener.handle(event->channel, event->data);
    now_s = std::max(now_s, 1e-6 * static_cast<double>(event->utime));
    objects.handle(event->channel, event->data, now_s);
  }
  say(log.damage().value_or(""));
  return !log.damage();
}

/// Prints each event of the objects.
ObjectListener::Handlers printers(const Options& options) {
  if (options.quiet) return {};
  return {
      .on_detection =
          [](const ObjectDetection& event) { std::cout << detection_text(event) << std::flush; },
      .on_change =
          [](const ChangeReport& event) { std::cout << change_text(event) << std::flush; }};
}

int run(const Options& options) {
  check_folder_of(options.json_file);
  check_different({{"--log", options.log}}, {{"--json", options.json_file}});
  SegmentListener listener(options.map_name, [&options](const SegmentUpdate& update) {
    if (!options.quiet) std::cout << update_text(update, options.grown) << std::flush;
  });
  ObjectListener objects(options.map_name, printers(options));
  bool is_read = true;
  if (options.log.empty()) {
    listen(listener, objects, options);
  } else {
    is_read = read_log(listener, objects, options.log);
  }
  std::cout << table_text(listener.table(), options.num_listed) << std::flush;
  if (!options.json_file.empty()) {
    AtomicFile file(options.json_file);
    write_table_json(listener.table(), is_read && listener.is_whole(), file.stream());
    file.commit();
  }
  say(listener.dropped());
  say(listener.problem());
  say(objects.dropped());
  say(objects.losses());
  return is_read && listener.is_whole() ? 0 : 1;
}

}  // namespace
}  // namespace kintsugi

int main(int argc, char** argv) {
  return kintsugi::run_main(argv, [&] {
    kintsugi::Options options;
    CLI::App app(
        "Prints which segments of a map are created, merged, split and retired, which known "
        "objects are found, confirmed, moved and gone, what kintsugi-diff reports, and at the end "
        "the table of all segments. Exit status 1: updates are missing, or the log is damaged or "
        "was not read to its end.");
    auto* url =
        app.add_option("--lcm-url", options.url,
                       "URL of the bus; default: LCM_DEFAULT_URL, or multicast on this host");
    auto* log =
        app.add_option("--log", options.log, "Read this LCM log instead of the bus")->excludes(url);
    kintsugi::add_log_trust_flags(app);
    app.add_option("--map-name", options.map_name,
                   "Follow the map with this name (default: the first that is received)");
    app.add_flag("--exit-on-final", options.exit_on_final,
                 "Exit when the map is complete, not only on Ctrl-C")
        ->excludes(log);
    app.add_flag("--grown", options.grown, "Print a line for each segment that grew, too");
    app.add_flag("--quiet", options.quiet, "Print only the table at the end");
    app.add_option("--top", options.num_listed, "Number of segments in the printed table")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_option("--json", options.json_file, "Write the whole table to this file, as JSON");
    kintsugi::add_version_flag(app);
    CLI11_PARSE(app, argc, argv);
    kintsugi::install_stop_signals();
    return kintsugi::run(options);
  });
}

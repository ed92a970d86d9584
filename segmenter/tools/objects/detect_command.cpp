// kintsugi-objects detect

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/number_range.hpp"
#include "lcmtypes/base/output_files.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/signing/process_key.hpp"
#include "segmenter/objects/library/object_library.hpp"
#include "segmenter/objects/process/detection_messages.hpp"
#include "segmenter/objects/process/detector_process.hpp"
#include "segmenter/objects/process/map_detection.hpp"
#include "segmenter/tools/objects/command.hpp"
#include "segmenter/tools/objects/object_text.hpp"
#include "segmenter/tools/objects/taught_map.hpp"

namespace kintsugi::segmenter {
namespace {

struct DetectOptions {
  std::optional<std::filesystem::path> map;
  DetectorOptions live;
  bool only_check = false;
};

ObjectLibrary read_library(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder)) {
    throw std::runtime_error(folder.string() +
                             ": there is no such library: kintsugi-objects teach makes it");
  }
  return ObjectLibrary::read(folder);
}

int detect_in_map(const DetectOptions& options) {
  const ObjectLibrary library = read_library(options.live.library);
  warn_of_refusals(library);
  const ObservedMap map = read_taught_map(*options.map);
  const auto [detector, cost] = detect_in(map, library);
  std::cout << detections_text(*detector) << std::flush;
  spdlog::info(
      "{} objects prepared in {:.2f} s, {} segments examined in {:.2f} s of processor time",
      library.objects().size(), cost.prepare_s, cost.num_segments, cost.examine_s);
  if (options.live.json.empty()) return 0;
  AtomicFile file(options.live.json);
  file.stream() << detections_json(*detector, {.map = options.map->string()});
  file.commit();
  return 0;
}

int detect(const DetectOptions& options) {
  check_folder_of(options.live.json);
  if (options.only_check) {
    warn_of_refusals(read_library(options.live.library));
    return 0;
  }
  if (options.map) return detect_in_map(options);
  install_stop_signals();
  read_library(options.live.library);  // an error before anything is opened
  return run_detector(options.live);
}

}  // namespace

void add_detect_command(CLI::App& app, ObjectsAction& action) {
  const auto options = std::make_shared<DetectOptions>();
  CLI::App& command = *app.add_subcommand(
      "detect", "finds the known objects in a map, or in the one that grows on the bus");
  command.add_option("MAP", options->map,
                     "a saved map, a labelled PLY file or a log; without it the map on the bus is "
                     "followed until a stop signal, and the objects are published");
  add_library_option(command, options->live.library);
  command.add_option("--json", options->live.json,
                     "also write the objects that are there at the end as JSON");
  command.add_option("--map-name", options->live.map_name,
                     "on the bus: the map of this name (default: the first one it hears of)");
  command.add_option("--lcm-url", options->live.lcm_url, "the bus (default: LCM_DEFAULT_URL)");
  add_log_trust_flags(command);
  command
      .add_option(
          "--cpu-share", options->live.cpu_share,
          "on the bus: as much of one core may be used on average while the map grows; what "
          "does not fit waits")
      ->capture_default_str()
      ->check(number_range(0.001, 1.0));
  command.add_flag("--exit-on-final", options->live.exit_on_final,
                   "on the bus: exit when the final slice is segmented and examined");
  command.add_flag(
      "--check", options->only_check,
      "check the options and the library and exit: 0 if all is well, or with the reason");
  command.callback([options, &action] { action = [options] { return detect(*options); }; });
}

}  // namespace kintsugi::segmenter

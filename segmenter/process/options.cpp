#include "segmenter/process/options.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <spdlog/fmt/fmt.h>

#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/number_range.hpp"
#include "lcmtypes/base/output_files.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/log/whole_log_reader.hpp"
#include "lcmtypes/signing/process_key.hpp"
#include "segmenter/core/parameters/presets.hpp"

namespace kintsugi::segmenter {
namespace {

template <class Fn>
void for_each_option(const Fn& fn) {
  for (const EngineParameter& parameter : kMapParameters) {
    if (!parameter.comes_with_slices) fn(parameter);
  }
}

/// Sets the options that were not given by themselves, and what --print-config shows for them.
void apply_preset(const std::string& name, CLI::App& app, EngineConfig& engine) {
  const EngineConfig chosen = preset(name);
  for_each_option([&](const EngineParameter& parameter) {
    CLI::Option* const option = app.get_option(option_name(parameter));
    if (!option->empty()) return;
    engine.*parameter.value = chosen.*parameter.value;
    option->capture_default_str();
  });
}

std::string help_of(const EngineParameter& parameter) {
  const std::string unit = parameter.unit.empty() ? "" : fmt::format(" ({})", parameter.unit);
  return fmt::format("{}{}; {}", parameter.help, unit, parameter.bound.text);
}

void add_parameter_options(CLI::App& app, EngineConfig& engine, std::string_view default_preset) {
  app.add_option_function<std::string>(
         "--preset", [&app, &engine](const std::string& name) { apply_preset(name, app, engine); },
         "values for the parameters that are not given: objects, so that objects come out whole, "
         "or paper, those of Finman et al.")
      ->check(CLI::IsMember(std::vector<std::string>(preset_names().begin(), preset_names().end())))
      ->default_str(std::string(default_preset));
  for_each_option([&](const EngineParameter& parameter) {
    app.add_option(option_name(parameter), engine.*parameter.value, help_of(parameter));
  });
  apply_preset(std::string(default_preset), app, engine);
}

}  // namespace

void add_segmentation_options(CLI::App& app, SegmentMapConfig& config,
                              std::string_view default_preset) {
  std::map<std::string, NeighbourSearch> searches;
  for (const NeighbourSearch search : {NeighbourSearch::kGrid, NeighbourSearch::kFlann}) {
    searches.emplace(name_of(search), search);
  }
  EngineConfig& engine = config.engine;
  app.add_option(
         "--mode", config.mode,
         "exact: the result of batch, at a cost that depends on what a slice changes; batch: "
         "Algorithm 1 over the whole map for each slice; voting: Algorithms 2-5, close to batch")
      ->capture_default_str();
  app.add_flag("--audit", engine.audit,
               "mode exact: compare it with batch after each slice, segments and join thresholds "
               "to the bit, and stop at the first difference; as slow as batch");
  add_parameter_options(app, engine, default_preset);
  app.add_option("--neighbours", engine.neighbour_search, "neighbour search: grid or flann")
      ->transform(CLI::CheckedTransformer(searches).description("{grid,flann}"))
      ->default_str(std::string(name_of(NeighbourSearch::kGrid)));
}

namespace {

void add_file_flags(CLI::App& app, Options& options) {
  SegmentationLoop::Config& segmentation = options.process.segmentation;
  SessionMap::Config& each_map = segmentation.maps.each_map;
  app.add_option("--out", segmentation.files.folder,
                 "folder for the map files segments.ply, .json and .csv, written at the end, on "
                 "SIGUSR1, and as --write-every says")
      ->capture_default_str();
  app.add_option("--write-every", each_map.write_every,
                 "also write the map files after every N slices, of which a batch of patches is "
                 "one; 0: do not")
      ->capture_default_str();
  app.add_option("--save", segmentation.files.save_file,
                 "also save the map in this file, for --resume, whenever the map files are "
                 "written; of several maps only the one in segments.ply is saved");
  app.add_option("--save-every", each_map.save_every,
                 "also save the map after every N slices, which is faster than writing the map "
                 "files; 0: do not")
      ->capture_default_str();
  app.add_option("--resume", segmentation.resume_file,
                 "continue the map saved in this file: slices in it are not segmented again; mode "
                 "and parameters must be those it was saved with");
  app.add_flag("--resume-if-saved", options.resume_if_saved,
               "continue the map in the file of --save, if that exists");
}

void add_slice_flags(CLI::App& app, Options& options) {
  SessionMaps::Config& maps = options.process.segmentation.maps;
  app.add_flag(
      "--coalesce", maps.each_map.coalesce,
      "mode batch: segment all waiting slices in one run: catches up sooner and gives the "
      "same partition, but segment ids may differ from one run to the next; with --log, in "
      "all modes: segment all waiting batches of patches in one run, as on the bus");
  app.add_option("--gap-timeout", options.gap_timeout_s,
                 "seconds to wait for a missing slice that nobody resends before the map "
                 "continues without it, > 0")
      ->check(number_range(0.001, 1e6))
      ->capture_default_str();
  app.add_option(
         "--max-queue", options.max_queue_mb,
         "MB of slices that are received but not yet segmented; further slices are "
         "refused and requested again when there is room, > 0; of a log at least a batch of "
         "patches is read")
      ->check(number_range(1e-6, 1e6))
      ->capture_default_str();
  app.add_option("--max-memory", options.max_memory_mb,
                 "mode exact: MB of memory that the process may have, not counted what the system "
                 "can take back at any time; parts of the map that are not used for long go to a "
                 "file, and come back when something touches them. The result is the same. 0: no "
                 "limit")
      ->check(number_range(0.0, 1e9))
      ->capture_default_str();
  app.add_option("--swap-folder", options.swap_folder,
                 "folder, on a disk, of the file for --max-memory, which has no name and is gone "
                 "with the process (default: that of --out)");
  app.add_option("--map-name", maps.map_name,
                 "only the map of this name (default: all; maps not named 'map' are written as "
                 "segments_NAME)");
  app.add_option("--log", options.process.log,
                 "read the slices from this LCM log instead of the bus");
}

void add_bus_flags(CLI::App& app, Options& options) {
  app.add_option("--lcm-url", options.process.lcm_url,
                 "the bus (default: LCM_DEFAULT_URL); with --log, publish the results there");
  add_log_trust_flags(app);
  app.add_option("--rate", options.rate_mb_per_s, "MB/s of updates on the bus, > 0")
      ->check(number_range(1e-3, 1e6))
      ->capture_default_str();
  app.add_flag("--exit-on-final", options.process.exit_on_final,
               "exit when the final slice is segmented and published");
  app.add_option("--linger", options.process.linger_s,
                 "at the end, stay until nobody has requested a resend for so many seconds; "
                 "negative: until a stop signal")
      ->check(finite_number())
      ->capture_default_str();
}

/// What a run would refuse at its beginning.
void check_inputs(const SegmenterProcess::Config& config) {
  check_bus_url(config.lcm_url);
  if (!config.log.empty()) const WholeLogReader readable(config.log);
  const std::filesystem::path& resumed = config.segmentation.resume_file;
  if (!resumed.empty() && !std::ifstream(resumed).is_open()) {
    throw std::invalid_argument("--resume " + resumed.string() + ": cannot be read");
  }
}

}  // namespace

SegmenterProcess::Config Options::config() const {
  SegmenterProcess::Config config = process;
  SessionMaps::Config& maps = config.segmentation.maps;
  maps.each_map.order.gap_timeout = std::chrono::milliseconds(std::llround(gap_timeout_s * 1000.0));
  maps.each_map.order.is_live = config.log.empty() || maps.each_map.coalesce;
  config.max_queue_bytes = static_cast<std::size_t>(std::llround(max_queue_mb * 1e6));
  config.updates.rate_bytes_per_s = rate_mb_per_s * 1e6;
  config.updates.map_name = maps.map_name;
  if (max_memory_mb > 0.0) {
    const std::string& mode = maps.map.mode;
    if (mode != "exact") {
      throw std::invalid_argument("--max-memory needs mode exact, the mode is " + mode);
    }
    if (!swap_folder.empty() && !std::filesystem::is_directory(swap_folder)) {
      throw std::invalid_argument("--swap-folder " + swap_folder.string() +
                                  ": there is no such folder");
    }
    config.segmentation.swap = {
        .folder = swap_folder.empty() ? config.segmentation.files.folder : swap_folder,
        .max_anonymous_bytes = static_cast<std::size_t>(std::llround(max_memory_mb * 1e6))};
  } else if (!swap_folder.empty()) {
    throw std::invalid_argument("--swap-folder needs --max-memory MB");
  }
  const std::filesystem::path& saved = config.segmentation.files.save_file;
  if (saved.empty() && maps.each_map.save_every > 0) {
    throw std::invalid_argument("--save-every needs --save FILE, the file to save the map in");
  }
  check_different({{"--log", config.log}}, {{"--save", saved}});
  config.publish = config.log.empty() || !config.lcm_url.empty();
  if (resume_if_saved) {
    if (saved.empty()) {
      throw std::invalid_argument("--resume-if-saved needs --save FILE, the file to resume from");
    }
    if (config.segmentation.resume_file.empty() && std::filesystem::exists(saved)) {
      config.segmentation.resume_file = saved;
    }
  }
  return config;
}

std::variant<Options, int> parse_options(int argc, const char* const* argv) {
  CLI::App app{"Segments the map whose slices a mapper publishes, while it grows."};
  Options options;
  add_segmentation_options(app, options.process.segmentation.maps.map);
  add_file_flags(app, options);
  add_slice_flags(app, options);
  add_bus_flags(app, options);
  add_version_flag(app);
  add_config_flag(app, "read options from this file, in the format of --print-config");
  bool print_config = false;
  app.add_flag("--print-config", print_config, "print all options with their values, and exit")
      ->configurable(false);
  bool check_only = false;
  app.add_flag("--check", check_only,
               "check the options and exit: 0 if all is well, or with the reason")
      ->configurable(false);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }
  if (print_config) {
    std::cout << app.config_to_str(true, true);
    return 0;
  }
  if (check_only) {
    const SegmenterProcess::Config config = options.config();
    config.validate();
    check_inputs(config);
    return 0;
  }
  return options;
}

}  // namespace kintsugi::segmenter

// kintsugi-segmenter: keeps the segment map of a mapper's slices.

#include <exception>
#include <iostream>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "lcmtypes/base/stop_signal.hpp"
#include "segmenter/process/options.hpp"
#include "segmenter/process/segmenter_process.hpp"

namespace kintsugi::segmenter {
namespace {

struct Options {
  SegmenterProcess::Config process;
  double gap_timeout_s = 10.0;
  double max_queue_mb = 1024.0;
  double rate_mb_per_s = 10.0;
  bool resume_if_saved = false;
  bool print_config = false;
};

void add_options(CLI::App& app, Options& options) {
  SegmenterProcess::Config& process = options.process;
  SliceProcessor::Config& processor = process.maps.processor;
  add_segmentation_options(app, process.maps.map);
  app.add_option("--out", process.files.folder,
                 "folder for segments.ply, .json and .csv, written at the end, on SIGUSR1, and as "
                 "--write-every says")
      ->capture_default_str();
  app.add_option("--write-every", processor.write_every,
                 "also write them after so many slices; 0: do not")
      ->capture_default_str();
  app.add_option("--save", process.files.save_file,
                 "keep the map in this file too, whenever segments.ply is written, for --resume; "
                 "of several maps the one in segments.ply");
  app.add_option("--save-every", processor.save_every,
                 "also keep it after so many slices, which costs less; 0: do not")
      ->capture_default_str();
  app.add_option("--resume", process.resume_file,
                 "go on with the map in this file: slices it has are not segmented again; mode and "
                 "parameters must be those it was saved with");
  app.add_flag("--resume-if-saved", options.resume_if_saved,
               "go on with the map that --save has left, if there is one");
  app.add_flag("--coalesce", processor.coalesce,
               "mode batch: one run for all slices that are waiting: catches up sooner, gives the "
               "same partition, but the segment ids may differ from one time to the next");
  app.add_option("--gap-timeout", options.gap_timeout_s,
                 "seconds to wait for a missing slice that nobody sends again before going on "
                 "without it, > 0")
      ->check(CLI::Range(0.001, 1e6))
      ->capture_default_str();
  app.add_option("--max-queue", options.max_queue_mb,
                 "MB of slices that were received and are not segmented; more are asked for again "
                 "when there is room, > 0")
      ->check(CLI::Range(1e-6, 1e6))
      ->capture_default_str();
  app.add_option("--map-name", process.maps.map_name,
                 "only the map of this name (default: all; those other than 'map' are written as "
                 "segments_NAME)");
  app.add_option("--log", process.log, "read the slices from this LCM log instead of the bus");
  app.add_option("--lcm-url", process.lcm_url,
                 "the bus (default: LCM_DEFAULT_URL); with --log, publish there what is computed");
  app.add_option("--rate", options.rate_mb_per_s, "MB/s of updates on the bus, > 0")
      ->check(CLI::Range(1e-3, 1e6))
      ->capture_default_str();
  app.add_flag("--exit-on-final", process.exit_on_final,
               "end when the final slice is segmented and published");
  app.add_option("--linger", process.linger_s,
                 "after the end stay until nobody has asked for so many seconds for what was lost; "
                 "negative: until a stop signal")
      ->capture_default_str();
  app.set_config("--config", "", "read options from this file, as --print-config writes it");
  app.add_flag("--print-config", options.print_config, "print all options and their values")
      ->configurable(false);
}

void complete(Options& options) {
  SegmenterProcess::Config& process = options.process;
  process.maps.processor.order.gap_timeout =
      std::chrono::milliseconds(std::llround(options.gap_timeout_s * 1000.0));
  process.max_queue_bytes = static_cast<std::size_t>(std::llround(options.max_queue_mb * 1e6));
  process.updates.rate_bytes_per_s = options.rate_mb_per_s * 1e6;
  process.updates.map_name = process.maps.map_name;
  process.publish = process.log.empty() || !process.lcm_url.empty();
  if (!options.resume_if_saved) {
    return;
  }
  if (process.files.save_file.empty()) {
    throw std::invalid_argument("--resume-if-saved needs --save FILE, to know what to go on with");
  }
  if (process.resume_file.empty() && std::filesystem::exists(process.files.save_file)) {
    process.resume_file = process.files.save_file;
  }
}

}  // namespace
}  // namespace kintsugi::segmenter

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter;
  spdlog::set_default_logger(spdlog::stderr_color_mt("kintsugi-segmenter"));
  spdlog::set_pattern("%H:%M:%S.%e segmenter %^%l%$: %v");
  CLI::App app{"Keeps a segment map of the slices that a mapper publishes."};
  Options options;
  add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  if (options.print_config) {
    std::cout << app.config_to_str(true, true);
    return 0;
  }
  try {
    complete(options);
    kintsugi::install_stop_signals();
    return SegmenterProcess(options.process).run();
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
}

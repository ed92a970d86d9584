// kintsugi-segmenter: keeps the segment map of a mapper's slices.

#include <exception>
#include <iostream>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "lcmtypes/stop_signal.hpp"
#include "segmenter/options.hpp"
#include "segmenter/process/segmenter_process.hpp"

namespace kintsugi::segmenter {
namespace {

struct Options {
  SegmenterProcess::Config process;
  double gap_timeout_s = 10.0;
  bool print_config = false;
};

void add_options(CLI::App& app, Options& options) {
  SegmenterProcess::Config& process = options.process;
  add_segmentation_options(app, process.processor.map);
  app.add_option(
         "--out", process.files.folder,
         "folder for segments.ply and segments.json, written at the end, on SIGUSR1, and as "
         "--write-every says")
      ->capture_default_str();
  app.add_option("--write-every", process.processor.write_every,
                 "also write them after so many slices; 0: do not")
      ->capture_default_str();
  app.add_option("--save", process.files.save_file,
                 "keep the map in this file too, whenever segments.ply is written, for --resume");
  app.add_option("--resume", process.resume_file,
                 "go on with the map in this file: slices it has are not segmented again; mode and "
                 "parameters must be those it was saved with");
  app.add_flag("--coalesce", process.processor.coalesce,
               "mode batch: one run for all slices that are waiting: catches up sooner, gives the "
               "same partition, but the segment ids may differ from one time to the next");
  app.add_option("--gap-timeout", options.gap_timeout_s,
                 "seconds to wait for a missing slice before going on without it, > 0")
      ->check(CLI::Range(0.001, 1e6))
      ->capture_default_str();
  app.add_option("--map-name", process.processor.map_name,
                 "only slices of the map with this name (default: any)");
  app.add_option("--log", process.log, "read the slices from this LCM log instead of the bus");
  app.add_option("--lcm-url", process.lcm_url,
                 "the bus (default: LCM_DEFAULT_URL); with --log, publish there what is computed");
  app.add_flag("--exit-on-final", process.exit_on_final,
               "end when the final slice is segmented and published");
  app.set_config("--config", "", "read options from this file, as --print-config writes it");
  app.add_flag("--print-config", options.print_config, "print all options and their values")
      ->configurable(false);
}

void complete(Options& options) {
  SegmenterProcess::Config& process = options.process;
  process.processor.order.gap_timeout =
      std::chrono::milliseconds(std::llround(options.gap_timeout_s * 1000.0));
  process.publish = process.log.empty() || !process.lcm_url.empty();
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

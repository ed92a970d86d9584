// Time and memory of the segmentation engines on a whole map: slice by slice, all at once, and
// under corrections of the finished map. Prints Markdown tables.
//
//   bench_exact --modes exact,voting --corrections 1000
//   bench_exact --map loop.ply --modes exact --csv slices.csv --preset paper

#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <oneapi/tbb/global_control.h>

#include "segmenter/core/parameters/presets.hpp"
#include "tests/bench/bench_exact_corrections.hpp"
#include "tests/bench/bench_exact_report.hpp"
#include "tests/bench/bench_exact_slices.hpp"
#include "tests/bench/map_generator.hpp"

namespace kintsugi::segmenter::bench {
namespace {

struct Options {
  std::filesystem::path map;
  MapConfig generated;
  std::string preset{preset_names().front()};
  double resolution_m = EngineConfig{}.resolution_m;
  EngineConfig engine;  ///< of the preset and the resolution
  std::vector<std::string> modes = {"exact"};
  CorrectionsConfig corrections = {.num_single = 0};
  bool measures_batch = true;
  std::filesystem::path csv;
  std::size_t threads = 0;  ///< 0: one for each core
};

Options parse_command_line(int argc, char** argv) {
  Options options;
  CLI::App app("Engines on a whole map: time and memory");
  app.add_option("--map", options.map, "PLY with normals and slice_id, or .bin")
      ->check(CLI::ExistingFile);
  app.add_option("--points", options.generated.num_points,
                 "size of the generated map (without --map)")
      ->capture_default_str();
  app.add_option("--rooms", options.generated.num_rooms, "of the generated map")
      ->capture_default_str();
  app.add_option("--noise", options.generated.noise, "of the generated map")->capture_default_str();
  app.add_option("--map-seed", options.generated.seed, "of the generated map")
      ->capture_default_str();
  app.add_option("--modes", options.modes, "engines that get the map slice by slice")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--preset", options.preset, "parameters of the engines")->capture_default_str();
  app.add_option("--resolution", options.resolution_m, "voxel size of the map, m")
      ->capture_default_str();
  app.add_option("--corrections", options.corrections.num_single,
                 "corrections of single points of the finished map; 0: none")
      ->capture_default_str();
  app.add_option("--seed", options.corrections.seed, "random seed of the corrections")
      ->capture_default_str();
  app.add_flag("--cpu", options.corrections.measures_cpu,
               "measure corrections by CPU time instead of wall time");
  app.add_flag("--batch,!--no-batch", options.measures_batch, "also segment the whole map at once");
  app.add_option("--csv", options.csv, "write the times of each slice (last mode only)");
  app.add_option("--threads", options.threads, "of parallel stages; 0: one for each core")
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  options.engine = preset(options.preset);
  options.engine.resolution_m = options.resolution_m;
  return options;
}

int run(const Options& options) {
  const Stopwatch stopwatch;
  const Slices slices =
      options.map.empty() ? generate_map(options.generated) : read_map(options.map);
  std::optional<oneapi::tbb::global_control> limit;
  if (options.threads > 0) {
    limit.emplace(oneapi::tbb::global_control::max_allowed_parallelism, options.threads);
  }
  std::cerr << slices.size() << " slices after " << number(stopwatch.wall_ms()) << " ms\n";
  for (const std::string& mode : options.modes) {
    bench_slices(mode, options.engine, slices, options.csv);
  }
  if (options.measures_batch) {
    bench_whole("batch", options.engine, slices);
    bench_whole(options.modes.front(), options.engine, slices);
  }
  if (options.corrections.num_single == 0) return 0;
  const bool agrees =
      bench_corrections(options.modes.front(), options.engine, slices, options.corrections);
  return agrees ? 0 : 1;
}

}  // namespace
}  // namespace kintsugi::segmenter::bench

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter::bench;
  try {
    return run(parse_command_line(argc, argv));
  } catch (const std::exception& error) {
    std::cerr << "bench_exact: " << error.what() << '\n';
    return 2;
  }
}

// Runs an engine through random scenarios and compares it with batch after every step:
//
//   fuzz_exact --steps 50000 --map office.ply --map loop.ply
//
// Prints the number of steps at the end. A scenario that fails is shrunk, printed, and saved as a
// file for --replay.

#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>
#include <oneapi/tbb/global_control.h>

#include "tests/bench/map_generator.hpp"
#include "tests/fuzz/isolated_run.hpp"
#include "tests/fuzz/random_scenario.hpp"
#include "tests/fuzz/shrink.hpp"

namespace kintsugi::segmenter::fuzz {
namespace {

struct Options {
  std::string mode = "exact";
  std::uint64_t seed = 1;
  std::size_t steps = 50'000;
  double minutes = 0.0;  ///< 0: until the steps are done
  std::vector<std::filesystem::path> maps;
  std::filesystem::path replay;
  std::filesystem::path failures = ".";
  ScenarioBounds bounds;
  int max_failures = 3;
  int shrink_trials = 3000;
};

constexpr int kTimeout_s = 60;  // a scenario takes about one second

Options parse_command_line(int argc, char** argv) {
  Options options;
  CLI::App app("Runs an engine over random maps and compares it with batch after every step");
  app.add_option("--mode", options.mode, "engine to check")->capture_default_str();
  app.add_option("--seed", options.seed, "seed of the first scenario; each next one is higher by 1")
      ->capture_default_str();
  app.add_option("--steps", options.steps, "number of steps to check")->capture_default_str();
  app.add_option("--minutes", options.minutes, "run for this time instead of --steps");
  app.add_option(
         "--map", options.maps,
         "cut scenarios out of these maps (PLY with normals, .bin); default: generated rooms")
      ->check(CLI::ExistingFile);
  app.add_option("--max-points", options.bounds.max_points, "largest number of points of a cloud")
      ->capture_default_str();
  app.add_option("--replay", options.replay, "run this scenario only")->check(CLI::ExistingFile);
  app.add_option("--failures", options.failures, "folder for scenarios that fail")
      ->check(CLI::ExistingDirectory)
      ->capture_default_str();
  app.add_option("--max-failures", options.max_failures, "stop after this number of failures")
      ->capture_default_str();
  app.add_option("--shrink-trials", options.shrink_trials, "limit for shrinking a failing scenario")
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  return options;
}

Outcome run(const Scenario& scenario, const std::string& mode) {
  return run_isolated([&] { return run_scenario(scenario, engine_factory(mode)); }, kTimeout_s);
}

/// Prints what is wrong and the smallest scenario that still shows it.
void report(const Options& options, std::uint64_t seed, const Scenario& scenario,
            const Outcome& outcome) {
  std::cout << "seed " << seed << ", step " << outcome.num_steps << " of " << scenario.steps.size()
            << ": " << *outcome.failure << std::endl;
  const auto fails = [&](const Scenario& s) { return run(s, options.mode).failure.has_value(); };
  const Scenario smallest = shrink(scenario, fails, options.shrink_trials);
  const auto file = options.failures / ("fuzz_" + std::to_string(seed) + ".txt");
  std::ofstream out(file);
  write_scenario(out, smallest);
  std::cout << "  smallest: " << smallest.pool.size() << " points, " << smallest.steps.size()
            << " steps: " << run(smallest, options.mode).failure.value_or("(passes)") << '\n'
            << "  fuzz_exact --mode " << options.mode << " --replay " << file.string() << std::endl;
  if (smallest.pool.size() <= 30) write_scenario(std::cout, smallest);
}

int replay(const Options& options) {
  std::ifstream in(options.replay);
  const Scenario scenario = read_scenario(in);
  const Outcome outcome = run(scenario, options.mode);
  std::cout << outcome.num_steps << " of " << scenario.steps.size()
            << " steps: " << outcome.failure.value_or("all right") << '\n';
  return outcome.failure ? 1 : 0;
}

std::vector<CloudPoint> generated_map() {
  return bench::all_points(bench::generate_map({.num_points = 300'000, .num_rooms = 4}));
}

int fuzz(const Options& options) {
  std::vector<std::vector<CloudPoint>> maps;
  maps.reserve(options.maps.size() + 1);
  for (const auto& file : options.maps) maps.push_back(bench::all_points(bench::read_map(file)));
  if (maps.empty()) maps.push_back(generated_map());

  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  std::size_t num_steps = 0;
  std::size_t num_rebuilt = 0;
  std::size_t num_scenarios = 0;
  int num_failures = 0;
  const auto is_done = [&] {
    if (num_failures >= options.max_failures) return true;
    return options.minutes > 0.0 ? seconds() >= 60.0 * options.minutes : num_steps >= options.steps;
  };
  for (std::uint64_t seed = options.seed; !is_done(); ++seed) {
    const Scenario scenario = random_scenario(seed, options.bounds, maps[seed % maps.size()]);
    const Outcome outcome = run(scenario, options.mode);
    num_steps += outcome.num_steps;
    num_rebuilt += outcome.num_rebuilt;
    ++num_scenarios;
    if (outcome.failure) {
      ++num_failures;
      report(options, seed, scenario, outcome);
    }
    if (num_scenarios % 100 == 0) {
      std::cerr << num_steps << " steps, " << static_cast<int>(seconds()) << " s\r";
    }
  }
  std::cout << options.mode << ": " << num_steps << " steps of " << num_scenarios
            << " scenarios checked against batch (seeds " << options.seed << " to "
            << options.seed + num_scenarios - 1 << ", " << static_cast<int>(seconds()) << " s; "
            << num_rebuilt << " steps rebuilt): " << num_failures << " failures" << std::endl;
  return num_failures == 0 ? 0 : 1;
}

}  // namespace
}  // namespace kintsugi::segmenter::fuzz

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter::fuzz;
  try {
    const Options options = parse_command_line(argc, argv);
    // run_isolated() wants no other thread.
    const oneapi::tbb::global_control one_thread(
        oneapi::tbb::global_control::max_allowed_parallelism, 1);
    return options.replay.empty() ? fuzz(options) : replay(options);
  } catch (const std::exception& error) {
    std::cerr << "fuzz_exact: " << error.what() << '\n';
    return 2;
  }
}

// What a batch of patches costs the segmenter: a generated map, cut into tiles, whose patches are
// revised in batches. Prints the CPU time of SegmentMap::add() as a Markdown table, and how many
// segment ids changed hands.
//
//   bench_patches --points 1000000 --batches 100

#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/map/segment_map.hpp"
#include "tests/bench/bench_exact_report.hpp"
#include "tests/bench/map_generator.hpp"
#include "tests/bench/map_generator_patches.hpp"
#include "tests/fuzz/random.hpp"

namespace kintsugi::segmenter::bench {
namespace {

using fuzz::Random;

struct Options {
  MapConfig map{.num_points = 1'000'000};
  std::string preset{"objects"};
  double tile_m = 0.5;
  double jitter_m = 0.001;
  double share_lost = 0.02;
  std::size_t num_batches = 60;
  std::size_t num_patches = 20;
  std::uint64_t seed = 1;
  EngineConfig engine;  ///< for its explore_share
};

constexpr double kResolution_m = 0.01;

Options parse_command_line(int argc, char** argv) {
  Options options;
  CLI::App app("Batches of patches in a large map");
  app.add_option("--points", options.map.num_points, "size of the map")->capture_default_str();
  app.add_option("--preset", options.preset, "parameters of the engine")->capture_default_str();
  app.add_option("--tile", options.tile_m, "side of a patch, m")->capture_default_str();
  app.add_option("--jitter", options.jitter_m, "most that a point moves along each axis, m")
      ->capture_default_str();
  app.add_option("--lost", options.share_lost, "share of points that a revision leaves out")
      ->capture_default_str();
  app.add_option("--batches", options.num_batches, "how many")->capture_default_str();
  app.add_option("--patches", options.num_patches, "in a batch")->capture_default_str();
  app.add_option("--explore-share", options.engine.explore_share, "of the engine")
      ->capture_default_str();
  app.add_option("--seed", options.seed, "of the revisions")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  return options;
}

CloudSlice revised(const CloudSlice& patch, std::int32_t revision, Random& random,
                   const Options& options) {
  CloudSlice result = patch;
  result.revision = revision;
  result.points_W.clear();
  const auto jitter = [&] {
    return static_cast<float>(random.uniform(-options.jitter_m, options.jitter_m));
  };
  constexpr double kTilt = 0.01;
  for (CloudPoint p : patch.points_W) {
    if (random.chance(options.share_lost)) continue;
    p.x += jitter();
    p.y += jitter();
    p.z += jitter();
    const double nx = p.nx + random.uniform(-kTilt, kTilt);
    const double ny = p.ny + random.uniform(-kTilt, kTilt);
    const double nz = p.nz + random.uniform(-kTilt, kTilt);
    const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
    p.nx = static_cast<float>(nx / length);
    p.ny = static_cast<float>(ny / length);
    p.nz = static_cast<float>(nz / length);
    result.points_W.push_back(p);
  }
  return result;
}

int run(const Options& options) {
  std::vector<CloudSlice> patches =
      cut_into_patches(generate_map(options.map), options.tile_m, kResolution_m);
  SegmentMapConfig config;
  config.engine = preset(options.preset);
  config.engine.explore_share = options.engine.explore_share;
  SegmentMap map(config, 1, patches[0]);
  const Stopwatch all;
  map.add(patches);
  std::cout << patches.size() << " patches of " << count(map.cloud().num_live())
            << " points: " << number(all.cpu_ms()) << " ms of CPU\n\n";

  Random random(options.seed);
  Sample points;
  Sample ms;
  std::map<SegmentEventType, std::size_t> num_events;
  for (std::size_t b = 0; b < options.num_batches; ++b) {
    std::vector<CloudSlice> batch;
    const std::size_t first = random.below(patches.size() - options.num_patches);
    double num_points = 0.0;
    for (std::size_t k = first; k < first + options.num_patches; ++k) {
      const auto revision = static_cast<std::int32_t>(b) + 1;
      batch.push_back(revised(patches[k], revision, random, options));
      num_points += static_cast<double>(batch.back().points_W.size());
    }
    const Stopwatch stopwatch;
    const auto updates = map.add(batch);
    ms.add(stopwatch.cpu_ms());
    points.add(num_points);
    for (const SegmentEvent& event : updates.back().events) ++num_events[event.type];
  }
  print_head({"batches", "points each", "p50, ms", "p90, ms", "max, ms", "us a point"});
  print_row({count(ms.size()), number(points.average()), number(ms.quantile(0.5)),
             number(ms.quantile(0.9)), number(ms.max()),
             number(1e3 * ms.average() / points.average())});
  std::cout << "\nevents: " << num_events[SegmentEventType::kCreated] << " created, "
            << num_events[SegmentEventType::kGrown] << " grown, "
            << num_events[SegmentEventType::kMerged] << " merged, "
            << num_events[SegmentEventType::kSplit] << " split, "
            << num_events[SegmentEventType::kRetired] << " retired\n";
  return 0;
}

}  // namespace
}  // namespace kintsugi::segmenter::bench

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter::bench;
  try {
    return run(parse_command_line(argc, argv));
  } catch (const std::exception& error) {
    std::cerr << "bench_patches: " << error.what() << '\n';
    return 2;
  }
}

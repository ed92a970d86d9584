// A map beyond memory: times of slices, memory and a digest of the partition, with a limit on
// memory and without. Prints Markdown tables.
//
//   bench_memory --points 50000000                                    # all in memory
//   bench_memory --points 50000000 --max-memory 4000 --swap-folder .  # the rest on disk
//   bench_memory --points 50000000 --batch                            # batch, for its digest

#include <algorithm>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <malloc.h>
#include <spdlog/fmt/fmt.h>
#include <sys/resource.h>

#include "lcmtypes/base/growing_array.hpp"
#include "lcmtypes/base/process_memory.hpp"
#include "lcmtypes/base/swap_space.hpp"
#include "segmenter/core/ids/segment_ids.hpp"
#include "segmenter/core/make_engine.hpp"
#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/map/segment_statistics.hpp"
#include "tests/bench/bench_exact_report.hpp"
#include "tests/bench/map_generator.hpp"

namespace kintsugi::segmenter::bench {
namespace {

constexpr double kMegabyte = 1e6;
constexpr double kPointsOfRoom = 4e6 / 14;  ///< of the default of the generator

struct Options {
  std::size_t num_points = 5'000'000;
  double max_memory_mb = 0.0;  ///< 0: no limit
  std::filesystem::path swap_folder = ".";
  bool is_batch = false;
};

/// The generated map, whose points may go to disk like those of the segmenter.
struct Walk {
  GrowingArray<CloudPoint> points_W;
  std::vector<std::size_t> first;  ///< of each slice, and the number of points

  [[nodiscard]] std::size_t num_slices() const { return first.size() - 1; }
  [[nodiscard]] std::span<const CloudPoint> slice(std::size_t k) const {
    return points_W.span().subspan(first[k], first[k + 1] - first[k]);
  }
};

std::size_t max_bytes(const Options& options) {
  return static_cast<std::size_t>(options.max_memory_mb * kMegabyte);
}

/// A limit may be below what can go to disk at all.
void trim_all(SwapSpace& space) {
  const auto anonymous_bytes = [] { return process_memory().anonymous_bytes; };
  for (std::int64_t before = INT64_MAX; anonymous_bytes() < before;) {
    before = anonymous_bytes();
    space.trim();
  }
}

/// Other rooms all the way: as many as points are wanted.
Walk generate(const Options& options, SwapSpace* space) {
  const auto num_rooms =
      std::max(1, static_cast<int>(static_cast<double>(options.num_points) / kPointsOfRoom));
  Slices slices = generate_map({.num_points = options.num_points, .num_rooms = num_rooms});
  Walk walk;
  if (space != nullptr) walk.points_W.swap_to(*space);
  for (std::vector<CloudPoint>& slice : slices) {
    walk.first.push_back(walk.points_W.size());
    for (const CloudPoint& point : slice) walk.points_W.push_back(point);
    slice = {};
    if (space != nullptr) space->trim();
  }
  walk.first.push_back(walk.points_W.size());
  ::malloc_trim(0);  // what the generator had would count as the segmenter's
  if (space != nullptr) trim_all(*space);
  return walk;
}

/// Of a partition: the same for the same partition of the points in the same order, whatever its
/// components are called (FNV-1a over their names by first point).
std::string digest_of(std::span<const ComponentId> components) {
  std::vector<std::uint32_t> name(components.size(), 0);
  std::uint32_t num_names = 0;
  std::uint64_t digest = 0xCBF29CE484222325U;
  for (const ComponentId component : components) {
    if (name[component] == 0) name[component] = ++num_names;
    digest = (digest ^ name[component]) * 0x100000001B3U;
  }
  return fmt::format("{:016x}", digest);
}

std::string megabytes(std::int64_t bytes) { return number(static_cast<double>(bytes) / kMegabyte); }

std::int64_t major_faults() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_majflt;
}

void run_batch(const Options& options, const EngineConfig& config) {
  const Walk walk = generate(options, nullptr);
  PointCloud cloud;
  for (std::size_t k = 0; k < walk.num_slices(); ++k) {
    cloud.add_slice(static_cast<std::int32_t>(k), walk.slice(k));
  }
  const auto engine = make_engine("batch", cloud, config);
  engine->update(cloud.take_change());
  print_head({"all at once", ""});
  print_row({"points", count(cloud.size())});
  print_row({"digest of the partition", digest_of(engine->components())});
}

void run_slices(const Options& options, const EngineConfig& config) {
  std::optional<SwapSpace> space;
  if (options.max_memory_mb > 0.0) {
    space.emplace(SwapSpace::Config{options.swap_folder, max_bytes(options)});
  }
  const Walk walk = generate(options, space ? &*space : nullptr);
  PointCloud cloud;
  SegmentIds ids;
  SegmentStatisticsTable statistics(static_cast<float>(config.resolution_m));
  const auto engine = make_engine("exact", cloud, config);
  if (space) {
    cloud.swap_to(*space);
    engine->swap_to(*space);
    ids.swap_to(*space);
    statistics.swap_to(*space);
  }
  Sample all_ms;
  Sample last_ms;
  std::int64_t max_resident_bytes = 0;
  std::int64_t max_anonymous_bytes = 0;
  const std::int64_t faults_before = major_faults();
  const Stopwatch whole;
  for (std::size_t k = 0; k < walk.num_slices(); ++k) {
    const Stopwatch stopwatch;
    cloud.add_slice(static_cast<std::int32_t>(k), walk.slice(k));
    const CloudChange change = cloud.take_change();
    engine->update(change);
    const IdUpdate update = ids.update(cloud, change, engine->components(), engine->changed());
    statistics.apply(cloud, ids, update.changes);
    const ProcessMemory memory = process_memory();
    max_resident_bytes = std::max(max_resident_bytes, memory.resident_bytes);
    max_anonymous_bytes = std::max(max_anonymous_bytes, memory.anonymous_bytes);
    if (space) space->trim();
    all_ms.add(stopwatch.wall_ms());
    if (walk.first[k] + 1'000'000 > walk.points_W.size()) last_ms.add(stopwatch.wall_ms());
    if (k % 100 == 0) std::cerr << "slice " << k << " of " << walk.num_slices() << '\r';
  }
  const double cpu_ms = whole.cpu_ms();
  print_head({"slice by slice", ""});
  print_row({"points", count(cloud.size())});
  print_row({"limit, MB", space ? number(options.max_memory_mb) : "none"});
  print_row({"a slice, ms: average", number(all_ms.average())});
  print_row({"a slice, ms: median", number(all_ms.quantile(0.5))});
  print_row({"a slice, ms: p99", number(all_ms.quantile(0.99))});
  print_row({"a slice, ms: largest", number(all_ms.max())});
  print_row({"a slice of the last million, ms: average", number(last_ms.average())});
  print_row({"a slice, CPU ms: average", number(cpu_ms / static_cast<double>(all_ms.size()))});
  print_row({"resident memory at most, MB", megabytes(max_resident_bytes)});
  print_row({"of these not of a file, at most, MB", megabytes(max_anonymous_bytes)});
  if (space) {
    print_row({"file, MB", megabytes(static_cast<std::int64_t>(space->file_bytes()))});
    print_row({"written, MB", megabytes(static_cast<std::int64_t>(space->written_bytes()))});
  }
  print_row(
      {"pages read from disk", count(static_cast<std::size_t>(major_faults() - faults_before))});
  print_row({"digest of the partition", digest_of(engine->components())});
}

Options parse_command_line(int argc, char** argv) {
  Options options;
  CLI::App app("A map beyond memory: time and memory");
  app.add_option("--points", options.num_points, "of the generated map")->capture_default_str();
  app.add_option("--max-memory", options.max_memory_mb, "MB; 0: no limit")->capture_default_str();
  app.add_option("--swap-folder", options.swap_folder, "for what does not fit")
      ->capture_default_str();
  app.add_flag("--batch", options.is_batch, "segment all at once, in memory");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  return options;
}

}  // namespace
}  // namespace kintsugi::segmenter::bench

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter;
  try {
    const bench::Options options = bench::parse_command_line(argc, argv);
    const EngineConfig config = preset("objects");
    options.is_batch ? bench::run_batch(options, config) : bench::run_slices(options, config);
  } catch (const std::exception& error) {
    std::cerr << "bench_memory: " << error.what() << '\n';
    return 2;
  }
}

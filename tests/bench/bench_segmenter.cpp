// The engines and their stages on one of three maps: a wavy sheet of 10 m x 10 m with 1 million
// points in strips, a generated map (generate_map()), or a file (read_map()):
//
//   build/release/bench/bench_segmenter --benchmark_repetitions=5
//   KINTSUGI_BENCH_POINTS=4000000 build/release/bench/bench_segmenter
//   KINTSUGI_BENCH_MAP=map.ply build/release/bench/bench_segmenter

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>
#include <malloc.h>
#include <oneapi/tbb/global_control.h>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/graph/grid_index.hpp"
#include "segmenter/core/graph/make_neighbour_index.hpp"
#include "segmenter/core/ids/segment_ids.hpp"
#include "segmenter/core/make_engine.hpp"
#include "segmenter/core/points/point_rows.hpp"
#include "tests/bench/map_generator.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using bench::Slices;

Slices sheet_in_strips() {
  constexpr std::size_t kSlicePoints = 4000;
  auto points = testing::random_cloud(testing::CloudShape::kWaves, 1'000'000, 1);
  std::stable_sort(points.begin(), points.end(),
                   [](const CloudPoint& a, const CloudPoint& b) { return a.x < b.x; });
  Slices slices;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (k % kSlicePoints == 0) slices.emplace_back();
    slices.back().push_back(points[k]);
  }
  return slices;
}

const Slices& map_slices() {
  static const Slices slices = [] {
    if (const char* const path = std::getenv("KINTSUGI_BENCH_MAP")) return bench::read_map(path);
    if (const char* const points = std::getenv("KINTSUGI_BENCH_POINTS")) {
      return bench::generate_map({.num_points = std::stoul(points)});
    }
    return sheet_in_strips();
  }();
  return slices;
}

const PointCloud& map_cloud() {
  static const PointCloud cloud = [] {
    PointCloud all;
    std::int32_t id = 0;
    for (const std::vector<CloudPoint>& points_W : map_slices()) all.add_slice(id++, points_W);
    return all;
  }();
  return cloud;
}

const EngineConfig kConfig;

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void report_slices(benchmark::State& state, std::vector<double> slice_ms) {
  std::sort(slice_ms.begin(), slice_ms.end());
  const auto quantile = [&](double q) {
    return slice_ms[static_cast<std::size_t>(q * static_cast<double>(slice_ms.size() - 1))];
  };
  state.counters["slices"] = static_cast<double>(slice_ms.size());
  state.counters["mean_ms"] =
      std::accumulate(slice_ms.begin(), slice_ms.end(), 0.0) / static_cast<double>(slice_ms.size());
  state.counters["median_ms"] = quantile(0.5);
  state.counters["p99_ms"] = quantile(0.99);
  state.counters["max_ms"] = slice_ms.back();
}

/// Peak of the resident memory of this process since construction, above its value then.
class PeakMemory {
 public:
  PeakMemory() {
    ::malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << 5;  // VmHWM = VmRSS
    at_start_bytes_ = status_bytes("VmRSS:");
  }
  std::size_t peak_bytes() const { return status_bytes("VmHWM:") - at_start_bytes_; }

 private:
  static std::size_t status_bytes(std::string_view field) {
    std::ifstream status("/proc/self/status");
    std::string word;
    std::size_t kilobytes = 0;
    while (status >> word && word != field) {
    }
    status >> kilobytes;
    return kilobytes * 1024;
  }
  std::size_t at_start_bytes_;
};

void neighbours_of_all(benchmark::State& state, NeighbourSearch search) {
  for (auto _ : state) {
    const auto index = make_neighbour_index(search, map_cloud(), kConfig.radius_m());
    index->insert(map_cloud().everything().added);
    index->visit_all([](PointIndex, std::span<const PointIndex> neighbours) {
      benchmark::DoNotOptimize(neighbours.size());
    });
  }
  state.counters["points"] = static_cast<double>(map_cloud().size());
}
BENCHMARK_CAPTURE(neighbours_of_all, grid, NeighbourSearch::kGrid)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(neighbours_of_all, flann, NeighbourSearch::kFlann)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// Inserts slice after slice into the grid and finds the neighbours of its points, in one thread.
void grid_slice_by_slice(benchmark::State& state) {
  std::vector<double> slice_ms;
  for (auto _ : state) {
    PointCloud cloud;
    GridIndex index(cloud, kConfig.radius_m());
    std::int32_t id = 0;
    for (const std::vector<CloudPoint>& points_W : map_slices()) {
      cloud.add_slice(id++, points_W);
      const std::vector<PointIndex> points = cloud.take_change().added;
      const auto start = Clock::now();
      index.insert(points);
      GridIndex::Cursor cursor(index);
      std::size_t num_neighbours = 0;
      for (const PointIndex i : points) {
        cursor.for_each_neighbour(i, [&](PointIndex) { ++num_neighbours; });
      }
      benchmark::DoNotOptimize(num_neighbours);
      slice_ms.push_back(milliseconds_since(start));
    }
    state.counters["bytes_per_point"] = static_cast<double>(index.bytes()) / cloud.size();
  }
  report_slices(state, slice_ms);
}
BENCHMARK(grid_slice_by_slice)->Unit(benchmark::kMillisecond)->Iterations(1);

std::size_t num_pairs(const PointRows& rows) {
  std::size_t count = 0;
  for (std::size_t row = 0; row < rows.num_rows(); ++row) {
    rows.for_each_pair(
        row, [](PointRows::Slot, PointRows::Slot) { return true; },
        [&](PointRows::Slot, PointRows::Slot) { ++count; });
  }
  return count;
}

void rows(benchmark::State& state) {
  const std::vector<PointIndex> points = map_cloud().everything().added;
  for (auto _ : state) {
    benchmark::DoNotOptimize(PointRows(map_cloud(), points, kConfig.radius_m()).num_rows());
  }
}
BENCHMARK(rows)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// Runs in one thread.
void pairs_of_rows(benchmark::State& state) {
  const PointRows rows(map_cloud(), map_cloud().everything().added, kConfig.radius_m());
  std::size_t count = 0;
  for (auto _ : state) count = num_pairs(rows);
  state.counters["pairs"] = static_cast<double>(count);
}
BENCHMARK(pairs_of_rows)->Unit(benchmark::kMillisecond);

/// The whole map at once, from points to the partition.
void batch(benchmark::State& state, NeighbourSearch search) {
  using oneapi::tbb::global_control;
  const global_control threads(global_control::max_allowed_parallelism,
                               static_cast<std::size_t>(state.range(0)));
  const CloudChange change = map_cloud().everything();
  for (auto _ : state) {
    EngineConfig config = kConfig;
    config.neighbour_search = search;
    const PeakMemory memory;
    const auto engine = make_engine("batch", map_cloud(), config);
    benchmark::DoNotOptimize(engine->update(change).num_joins);
    state.counters["peak_bytes_per_point"] =
        static_cast<double>(memory.peak_bytes()) / map_cloud().size();
  }
}
BENCHMARK_CAPTURE(batch, grid, NeighbourSearch::kGrid)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(batch, flann, NeighbourSearch::kFlann)
    ->ArgName("threads")
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// The whole map slice by slice, with segment ids; the counters have the times of a slice.
void slice_by_slice(benchmark::State& state, std::string_view mode) {
  std::vector<double> slice_ms;
  double rounds = 0.0;
  for (auto _ : state) {
    PointCloud cloud;
    SegmentIds ids;
    const auto engine = make_engine(mode, cloud, kConfig);
    std::int32_t id = 0;
    for (const std::vector<CloudPoint>& points_W : map_slices()) {
      cloud.add_slice(id++, points_W);
      const auto start = Clock::now();
      const CloudChange change = cloud.take_change();
      rounds += engine->update(change).num_iterations;
      ids.update(cloud, change, engine->components(), engine->changed());
      slice_ms.push_back(milliseconds_since(start));
    }
  }
  state.counters["rounds_per_slice"] = rounds / static_cast<double>(slice_ms.size());
  report_slices(state, slice_ms);
}
BENCHMARK_CAPTURE(slice_by_slice, voting, "voting")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(1);

}  // namespace
}  // namespace kintsugi::segmenter

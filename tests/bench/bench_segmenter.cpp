// The engines and their stages on a map of 1 M points, one wavy sheet of 10 m x 10 m that comes in
// strips, or on a cloud of one's own (normals and slice_id needed):
//
//   build/release/bench/bench_segmenter --benchmark_repetitions=5
//   --benchmark_report_aggregates_only KINTSUGI_BENCH_PLY=map.ply
//   build/release/bench/bench_segmenter

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <vector>

#include <benchmark/benchmark.h>

#include "segmenter/core/engine.hpp"
#include "segmenter/core/felzenszwalb.hpp"
#include "segmenter/core/graph.hpp"
#include "segmenter/core/segment_ids.hpp"
#include "segmenter/io/ply_reader.hpp"
#include "tests/segmenter/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using Slices = std::map<std::int32_t, std::vector<CloudPoint>>;

Slices sheet_in_strips() {
  constexpr std::size_t kSlicePoints = 4000;
  auto points = testing::random_cloud(testing::CloudShape::kWaves, 1'000'000, 1);
  std::stable_sort(points.begin(), points.end(),
                   [](const CloudPoint& a, const CloudPoint& b) { return a.x < b.x; });
  Slices slices;
  for (std::size_t k = 0; k < points.size(); ++k) {
    slices[static_cast<std::int32_t>(k / kSlicePoints)].push_back(points[k]);
  }
  return slices;
}

const Slices& map_slices() {
  static const Slices slices = [] {
    const char* const path = std::getenv("KINTSUGI_BENCH_PLY");
    if (path == nullptr) return sheet_in_strips();
    const PlyCloud cloud = read_ply(path);
    Slices read;
    for (std::size_t k = 0; k < cloud.points_W.size(); ++k) {
      read[cloud.slice_ids.empty() ? 0 : cloud.slice_ids[k]].push_back(cloud.points_W[k]);
    }
    return read;
  }();
  return slices;
}

const PointCloud& map_cloud() {
  static const PointCloud cloud = [] {
    PointCloud all;
    for (const auto& [id, points_W] : map_slices()) all.add_slice(id, points_W);
    return all;
  }();
  return cloud;
}

const EngineConfig kConfig;

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

void graph(benchmark::State& state) {
  const auto index = make_neighbour_index(NeighbourSearch::kGrid, map_cloud(), kConfig.radius_m());
  index->insert(map_cloud().everything().added);
  std::size_t num_edges = 0;
  for (auto _ : state) {
    num_edges = build_graph(map_cloud(), *index, kConfig.threshold + kConfig.scale).size();
  }
  state.counters["edges"] = static_cast<double>(num_edges);
}
BENCHMARK(graph)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void joins(benchmark::State& state) {
  const auto index = make_neighbour_index(NeighbourSearch::kGrid, map_cloud(), kConfig.radius_m());
  index->insert(map_cloud().everything().added);
  const auto edges = build_graph(map_cloud(), *index, kConfig.threshold + kConfig.scale);
  for (auto _ : state) {
    state.PauseTiming();
    SegmentForest forest(kConfig.threshold, kConfig.scale);
    forest.grow(map_cloud().size());
    state.ResumeTiming();
    benchmark::DoNotOptimize(join_segments(edges, forest));
  }
}
BENCHMARK(joins)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

/// Everything from points to a partition, at once.
void batch(benchmark::State& state, NeighbourSearch search) {
  for (auto _ : state) {
    EngineConfig config = kConfig;
    config.neighbour_search = search;
    const auto engine = make_engine("batch", map_cloud(), config);
    benchmark::DoNotOptimize(engine->update(map_cloud().everything()).num_joins);
  }
}
BENCHMARK_CAPTURE(batch, grid, NeighbourSearch::kGrid)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(batch, flann, NeighbourSearch::kFlann)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// The whole map slice by slice, ids included; times per slice as counters.
void slice_by_slice(benchmark::State& state, std::string_view mode) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> slice_ms;
  double rounds = 0.0;
  for (auto _ : state) {
    PointCloud cloud;
    SegmentIds ids;
    const auto engine = make_engine(mode, cloud, kConfig);
    for (const auto& [id, points_W] : map_slices()) {
      cloud.add_slice(id, points_W);
      const auto start = Clock::now();
      const CloudChange change = cloud.take_change();
      rounds += engine->update(change).num_iterations;
      ids.update(cloud, change, engine->components(), engine->changed());
      slice_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
  }
  std::sort(slice_ms.begin(), slice_ms.end());
  const auto quantile = [&](double q) {
    return slice_ms[static_cast<std::size_t>(q * static_cast<double>(slice_ms.size() - 1))];
  };
  state.counters["slices"] = static_cast<double>(map_slices().size());
  state.counters["rounds_per_slice"] = rounds / static_cast<double>(slice_ms.size());
  state.counters["median_ms"] = quantile(0.5);
  state.counters["p99_ms"] = quantile(0.99);
  state.counters["max_ms"] = slice_ms.back();
}
BENCHMARK_CAPTURE(slice_by_slice, voting, "voting")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(1);

}  // namespace
}  // namespace kintsugi::segmenter

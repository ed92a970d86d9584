// Fusion, raycasting and extraction on the office scene: 640 x 480 with colour, 8.8 mm voxels.
//
//   build/release/bench/bench_volume --benchmark_repetitions=5 --benchmark_report_aggregates_only

#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include "mapper/core/extraction/surface_extractor.hpp"
#include "mapper/core/frame/rgbd_frame.hpp"
#include "mapper/core/frame/surface_pyramid.hpp"
#include "mapper/core/fusion/integrator.hpp"
#include "mapper/core/fusion/raycaster.hpp"
#include "mapper/core/kernels/instruction_set.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"
#include "mapper/synthetic/render/renderer.hpp"
#include "mapper/synthetic/rooms/scenes.hpp"

namespace kintsugi::mapper {
namespace {

struct View {
  RgbdFrame frame;
  Pose X_WC;
};

/// Frames at equal distances in time along the path of the office.
const std::vector<View>& office_views() {
  static const std::vector<View> views = [] {
    constexpr int kNumViews = 24;
    const auto office = synthetic::make_scene_with_path("office");
    std::vector<View> result;
    for (int i = 0; i < kNumViews; ++i) {
      const double t_s = office.trajectory.duration_s() * i / kNumViews;
      const auto rendered = synthetic::render(office.scene, synthetic::default_intrinsics(),
                                              office.trajectory.X_WC(t_s));
      result.push_back({.frame = {.intrinsics = rendered.intrinsics,
                                  .depth_m = rendered.depth_m,
                                  .color_rgb = rendered.color_rgb},
                        .X_WC = rendered.X_WC});
    }
    return result;
  }();
  return views;
}

TsdfVolume office_volume() {
  const std::vector<View>& views = office_views();
  TsdfVolume volume({}, views.front().X_WC.translation());
  const Integrator integrator({});
  for (const View& view : views) {
    volume.shift_to(view.X_WC.translation());
    integrator.integrate(view.frame, view.X_WC, volume);
  }
  return volume;
}

/// Arguments for stages that depend on the instruction set and the number of threads.
void for_each_path(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"instruction_set", "threads"});
  for (const InstructionSet instruction_set : kInstructionSets) {
    if (!is_supported(instruction_set)) continue;
    for (const int threads : {1, 2}) benchmark->Args({static_cast<int>(instruction_set), threads});
  }
  benchmark->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}

InstructionSet instruction_set_of(benchmark::State& state) {
  const auto instruction_set = static_cast<InstructionSet>(state.range(0));
  state.SetLabel(std::string(name_of(instruction_set)));
  return instruction_set;
}

class ThreadLimit {
 public:
  explicit ThreadLimit(const benchmark::State& state)
      : limit_(tbb::global_control::max_allowed_parallelism,
               static_cast<std::size_t>(state.range(1))) {}

 private:
  tbb::global_control limit_;
};

void integrate(benchmark::State& state) {
  const ThreadLimit limit(state);
  TsdfVolume volume = office_volume();
  const Integrator integrator({.instruction_set = instruction_set_of(state)});
  std::size_t i = 0;
  for (auto _ : state) {
    const View& view = office_views()[i++ % office_views().size()];
    integrator.integrate(view.frame, view.X_WC, volume);
  }
  state.counters["blocks"] = static_cast<double>(volume.num_blocks());
}
BENCHMARK(integrate)->Apply(for_each_path);

void raycast(benchmark::State& state, bool guided) {
  const ThreadLimit limit(state);
  const TsdfVolume volume = office_volume();
  const Raycaster raycaster({.instruction_set = instruction_set_of(state)});
  std::size_t i = 0;
  for (auto _ : state) {
    const View& view = office_views()[i++ % office_views().size()];
    benchmark::DoNotOptimize(raycaster.raycast(volume, view.X_WC, half_size(view.frame.intrinsics),
                                               guided ? view.frame.depth_m : cv::Mat_<float>()));
  }
}
BENCHMARK_CAPTURE(raycast, guided, true)->Apply(for_each_path);
BENCHMARK_CAPTURE(raycast, unguided, false)->Apply(for_each_path);

void extract(benchmark::State& state) {
  const DetachedBlocks blocks = office_volume().snapshot();
  const SurfaceExtractor extractor({.weight_threshold = 0});
  std::size_t num_points = 0;
  for (auto _ : state) num_points = extractor.extract(blocks).size();
  state.counters["blocks"] = static_cast<double>(blocks.coords.size());
  state.counters["points"] = static_cast<double>(num_points);
}
BENCHMARK(extract)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void snapshot(benchmark::State& state) {
  const TsdfVolume volume = office_volume();
  for (auto _ : state) benchmark::DoNotOptimize(volume.snapshot());
}
BENCHMARK(snapshot)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace kintsugi::mapper

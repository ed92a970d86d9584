// Drawing the picture of the viewer, 1280x720, over a generated room with 1 or 4 million points.

#include <benchmark/benchmark.h>

#include "tests/viewer/support/synthetic_room.hpp"
#include "viewer/core/figure/map_renderer.hpp"

namespace kintsugi::viewer {
namespace {

void draw_figure(benchmark::State& state, const Viewpoint& viewpoint) {
  constexpr double kResolution_m = 0.0088;
  constexpr double kPointsPerMetre = 18.0 / (kResolution_m * kResolution_m);
  const double length_m = 1e6 * static_cast<double>(state.range(0)) / kPointsPerMetre;
  const SyntheticMap room = make_room(length_m, kResolution_m);
  ReceivedMap map(room.slices.front().session);
  SmoothedCamera depth_camera;
  for (const CloudSlice& slice : room.slices) map.add_slice(slice);
  for (std::size_t i = 0; i < room.updates.size(); ++i) {
    map.apply_update(room.updates[i]);
  }
  for (const CameraPose& pose : room.poses) {
    map.add_pose(pose);
    depth_camera.update(pose, map.up(0).up_W());
  }

  const MapRenderer renderer{MapRenderer::Config{}};
  for (auto _ : state) {
    benchmark::DoNotOptimize(renderer.draw_figure(
        {map, 0, map.received_track(0), depth_camera, viewpoint}, caption(map, 0)));
  }
  state.counters["points"] = static_cast<double>(map.counts().points);
}

BENCHMARK_CAPTURE(draw_figure, follow, FollowViewpoint{})
    ->Arg(1)
    ->Arg(4)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(draw_figure, overview, OverviewViewpoint{})
    ->Arg(1)
    ->Arg(4)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kintsugi::viewer

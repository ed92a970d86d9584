// Times the figure over a synthetic map and, when given a folder, writes the pictures there:
//   viewer_bench_renderer [points in millions = 4] [threads = all] [folder]

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include <oneapi/tbb/global_control.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/viewer/synthetic_room.hpp"
#include "viewer/core/renderer.hpp"

namespace {

using namespace kintsugi;
using namespace kintsugi::viewer;

template <class Function>
double median_ms(Function&& function) {
  std::vector<double> times;
  for (int i = 0; i < 7; ++i) {
    const auto start = std::chrono::steady_clock::now();
    function();
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - start;
    times.push_back(elapsed.count());
  }
  std::ranges::nth_element(times, times.begin() + 3);
  return times[3];
}

}  // namespace

int main(int argc, char** argv) {
  const double millions = argc > 1 ? std::atof(argv[1]) : 4.0;
  const auto threads = argc > 2 ? static_cast<std::size_t>(std::atoi(argv[2]))
                                : std::size_t{std::thread::hardware_concurrency()};
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);

  constexpr double kResolution_m = 0.0088;
  constexpr double kPointsPerMetre = 18.0 / (kResolution_m * kResolution_m);
  const SyntheticMap room = make_room(millions * 1e6 / kPointsPerMetre, kResolution_m);
  Scene scene(room.slices.front().session);
  FollowedCamera followed;
  for (const CloudSlice& slice : room.slices) scene.add_slice(slice);
  for (std::size_t i = 0; i + 3 < room.updates.size(); ++i) {
    scene.apply_update(room.updates[i], static_cast<std::uint32_t>(i));
  }
  for (const CameraPose& pose : room.poses) {
    scene.add_pose(pose);
    followed.update(pose, -Eigen::Vector3d::UnitY());
  }

  const Renderer renderer{Renderer::Config{}};
  std::printf("%lld points, %zu threads, %dx%d\n", static_cast<long long>(scene.counts().points),
              threads, renderer.config().width_px, renderer.config().height_px);
  for (const char* name : {"follow", "overview"}) {
    const View view = parse_view(name);
    cv::Mat3b figure;
    const double figure_ms =
        median_ms([&] { figure = renderer.draw_figure(scene, followed, view, caption(scene)); });
    std::printf("%-8s  figure %.0f ms\n", name, figure_ms);
    if (argc > 3) cv::imwrite(std::string(argv[3]) + "/" + name + ".png", figure);
  }
  return 0;
}

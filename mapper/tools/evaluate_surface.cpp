// kintsugi-evaluate-surface: how far a map's points are from the true surface of a synthetic scene.

#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "mapper/evaluation/surface_error.hpp"
#include "mapper/tools/map_of_scene.hpp"

namespace {

using namespace kintsugi::mapper;

void evaluate(const MapOfSceneOptions& options) {
  const MapOfScene map = read_map_of_scene(options);
  if (map.points_W.empty()) throw std::runtime_error("the map has no points, nothing is evaluated");
  const SurfaceError error = surface_error(map.points_W, map.scene, map.X_SW);
  std::cout << "points " << error.num_points << "  per_m2 " << error.points_per_m2 << "  mean_m "
            << error.mean_m << "  median_m " << error.median_m << "  p95_m "
            << error.percentile_95_m << "  p99_m " << error.percentile_99_m << "  max_m "
            << error.max_m << "  normal_median_deg " << error.median_normal_deg
            << "  normal_p95_deg " << error.percentile_95_normal_deg << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  return kintsugi::run_main(argv, [&] {
    MapOfSceneOptions options;
    CLI::App app{"Distance of every point of a map from the true surface of a synthetic scene."};
    add_cloud(app, options);
    add_scene(app, options);
    add_scene_frame(app, options);
    kintsugi::add_version_flag(app);
    CLI11_PARSE(app, argc, argv);
    evaluate(options);
    return 0;
  });
}

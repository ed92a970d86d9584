// kintsugi-evaluate-surface: how far a map's points are from the true surface of a synthetic scene.

#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include "mapper/evaluation/surface_error.hpp"
#include "mapper/openni2_driver/recording_uri.hpp"
#include "mapper/output/cloud_reader.hpp"
#include "mapper/synthetic/sequence.hpp"

namespace {

using namespace kintsugi;
using namespace kintsugi::mapper;

struct Options {
  std::string cloud;
  std::string scene;
  bool in_scene_frame = false;
};

void evaluate(const Options& options) {
  const auto uri = parse_recording_uri(options.scene);
  if (!uri || uri->scheme != RecordingUri::Scheme::kSynthetic) {
    throw std::invalid_argument("'" + options.scene + "': expected synthetic://NAME?key=value&...");
  }
  const synthetic::Sequence sequence(synthetic::Sequence::Config::parse(uri->path, uri->options));
  const Pose X_SW = options.in_scene_frame ? Pose::Identity() : sequence.X_WC(0);
  const SurfaceError error = surface_error(read_cloud(options.cloud), sequence.scene(), X_SW);
  std::cout << "points " << error.num_points << "  per_m2 " << error.points_per_m2 << "  mean_m "
            << error.mean_m << "  median_m " << error.median_m << "  p95_m "
            << error.percentile_95_m << "  p99_m " << error.percentile_99_m << "  max_m "
            << error.max_m << "  normal_median_deg " << error.median_normal_deg
            << "  normal_p95_deg " << error.percentile_95_normal_deg << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Distance of every point of a map from the true surface of a synthetic scene."};
  app.add_option("CLOUD", options.cloud, "PLY file of kintsugi-mapper --cloud, or an LCM log")
      ->required();
  app.add_option("SCENE", options.scene, "the device that was mapped, synthetic://NAME?...")
      ->required();
  app.add_flag("--scene-frame", options.in_scene_frame,
               "the map is in the scene's frame (true poses were given), not in that of the camera "
               "at its first frame");
  CLI11_PARSE(app, argc, argv);
  try {
    evaluate(options);
    return 0;
  } catch (const std::exception& error) {
    spdlog::error("kintsugi-evaluate-surface: {}", error.what());
    return 1;
  }
}

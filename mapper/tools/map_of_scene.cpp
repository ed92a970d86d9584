#include "mapper/tools/map_of_scene.hpp"

#include <stdexcept>

#include <CLI/CLI.hpp>

#include "mapper/openni2_driver/recording/recording_uri.hpp"
#include "mapper/output/cloud_reader.hpp"
#include "mapper/synthetic/render/sequence.hpp"

namespace kintsugi::mapper {

void add_cloud(CLI::App& app, MapOfSceneOptions& options) {
  app.add_option("CLOUD", options.cloud, "PLY file of kintsugi-mapper --cloud, or an LCM log")
      ->required();
}

void add_scene(CLI::App& app, MapOfSceneOptions& options) {
  app.add_option("SCENE", options.scene, "the device that was mapped, synthetic://NAME?...")
      ->required();
}

void add_scene_frame(CLI::App& app, MapOfSceneOptions& options) {
  app.add_flag("--scene-frame", options.in_scene_frame,
               "the map is in the scene's frame (true poses were given), not in that of the camera "
               "at its first frame");
}

MapOfScene read_map_of_scene(const MapOfSceneOptions& options) {
  const auto uri = parse_recording_uri(options.scene);
  if (!uri || uri->scheme != RecordingUri::Scheme::kSynthetic) {
    throw std::invalid_argument("'" + options.scene + "': expected synthetic://NAME?key=value&...");
  }
  const auto config = synthetic::Sequence::Config::parse(uri->path, uri->options);
  const Pose X_SC = synthetic::Sequence(config).X_WC(0);
  return {.points_W = read_cloud(options.cloud),
          .scene = synthetic::make_scene(config.scene),
          .X_SW = options.in_scene_frame ? Pose::Identity() : X_SC};
}

}  // namespace kintsugi::mapper

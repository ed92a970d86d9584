#include "mapper/tools/map_of_scene.hpp"

#include <stdexcept>
#include <utility>

#include <CLI/CLI.hpp>

#include "lcmtypes/signing/process_key.hpp"
#include "mapper/openni2_driver/recording/recording_uri.hpp"
#include "mapper/output/cloud_reader.hpp"
#include "mapper/synthetic/render/sequence.hpp"

namespace kintsugi::mapper {

void add_cloud(CLI::App& app, MapOfSceneOptions& options) {
  app.add_option("CLOUD", options.cloud, "PLY file of kintsugi-mapper --cloud, or an LCM log")
      ->required();
  add_log_trust_flags(app);
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

SceneOfMap read_scene(const std::string& address, bool in_scene_frame) {
  const auto uri = parse_recording_uri(address);
  if (!uri || uri->scheme != RecordingUri::Scheme::kSynthetic) {
    throw std::invalid_argument("'" + address + "': expected synthetic://NAME?key=value&...");
  }
  const auto config = synthetic::Sequence::Config::parse(uri->path, uri->options);
  const synthetic::Sequence sequence(config);
  const Pose X_SC = sequence.X_WC(0);
  return {.scene = synthetic::make_scene_in_lap(config.scene, config.seed,
                                                sequence.lap_of(sequence.num_frames() - 1)),
          .X_SW = in_scene_frame ? Pose::Identity() : X_SC};
}

MapOfScene read_map_of_scene(const MapOfSceneOptions& options) {
  SceneOfMap mapped = read_scene(options.scene, options.in_scene_frame);
  return {
      .points_W = read_cloud(options.cloud), .scene = std::move(mapped.scene), .X_SW = mapped.X_SW};
}

}  // namespace kintsugi::mapper

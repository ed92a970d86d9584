#pragma once
// Shared by the tools that compare a map with the synthetic scene that was mapped.

#include <string>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"
#include "mapper/synthetic/scene/scene.hpp"

namespace CLI {
class App;
}

namespace kintsugi::mapper {

struct MapOfSceneOptions {
  std::string cloud;            ///< PLY file of kintsugi-mapper --cloud, or an LCM log
  std::string scene;            ///< the device that was mapped
  bool in_scene_frame = false;  ///< the map frame is the scene frame, because true poses were given
};

// Each adds one option to the command line.
void add_cloud(CLI::App& app, MapOfSceneOptions& options);
void add_scene(CLI::App& app, MapOfSceneOptions& options);
void add_scene_frame(CLI::App& app, MapOfSceneOptions& options);

/// A synthetic scene as a mapper saw it.
struct SceneOfMap {
  synthetic::Scene scene;
  Pose X_SW = Pose::Identity();  ///< of the map frame in the scene frame
};

/// @throws std::invalid_argument when the address is not that of a synthetic scene
SceneOfMap read_scene(const std::string& address, bool in_scene_frame);

/// A map and the scene that was mapped.
struct MapOfScene {
  std::vector<CloudPoint> points_W;
  synthetic::Scene scene;
  Pose X_SW = Pose::Identity();  ///< of the map frame in the scene frame
};

/// @throws std::invalid_argument when the scene is not synthetic, std::runtime_error naming the
/// file
///   of the cloud and what is wrong with it
MapOfScene read_map_of_scene(const MapOfSceneOptions& options);

}  // namespace kintsugi::mapper

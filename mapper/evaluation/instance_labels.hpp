#pragma once
// The true segmentation of a map: the instance of the synthetic scene to which each point belongs.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::synthetic {
class Scene;
}

namespace kintsugi::mapper {

/// For each point, in order, the id of the instance with the nearest surface (see
/// Scene::nearest_surface()), or 0 if that is farther than `max_distance_m`, which means that the
/// point is an artefact. `X_SW` is the pose of the map frame in the scene frame, as in
/// surface_error().
/// @throws std::invalid_argument unless max_distance_m is positive
std::vector<std::uint32_t> nearest_instances(const std::vector<CloudPoint>& points_W,
                                             const synthetic::Scene& scene, const Pose& X_SW,
                                             double max_distance_m);

/// Writes points and labels as a binary PLY file: `float x`, `float y`, `float z` (W, metres) and
/// `uint instance_id`; its header has a line `comment instance ID structure|object NAME` for each
/// instance of the scene.
/// @throws std::invalid_argument unless there are as many labels as points; std::system_error
///   naming the file
void write_instance_cloud(const std::filesystem::path& path,
                          const std::vector<CloudPoint>& points_W,
                          const std::vector<std::uint32_t>& labels, const synthetic::Scene& scene);

}  // namespace kintsugi::mapper

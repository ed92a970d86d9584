#pragma once
// The scenes by name, and the camera's path through each.

#include <cstdint>
#include <string>
#include <vector>

#include "mapper/synthetic/rooms/trajectory.hpp"
#include "mapper/synthetic/scene/scene.hpp"

namespace kintsugi::synthetic {

/// A scene and the path of a hand-held camera through it.
struct SceneWithPath {
  Scene scene;
  Trajectory trajectory;
};

/// "office", "loop", "two-floors" stand for the paper's three datasets; "sphere" (radius 0.5 m at
/// the origin), "plane" (z = 0, 4 m x 4 m) and "box-room" are small, for tests. "wall", "floor" and
/// "corridor" show nothing else, so that depth leaves open where along it the camera is; in
/// "wall-visit" the view goes from some things to the bare wall and back. Each of the four also as
/// "...-plain", without texture.
const std::vector<std::string>& scene_names();

/// Throws std::invalid_argument naming the scenes there are, if `name` is none of them.
Scene make_scene(const std::string& name);

/// The same, with the camera's path; `seed` is that of the hand's shake.
SceneWithPath make_scene_with_path(const std::string& name, std::uint32_t seed = 1);

}  // namespace kintsugi::synthetic

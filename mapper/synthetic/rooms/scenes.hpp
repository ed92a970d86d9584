#pragma once
// The scenes by name, and the camera's path through each.

#include <cstdint>
#include <string>
#include <vector>

#include "mapper/synthetic/rooms/scene_with_path.hpp"

namespace kintsugi::synthetic {

/// "office", "loop" and "two-floors" correspond to the three datasets of the paper. "office-later"
/// is the office some time later, 10 things gone, 10 new and 10 moved, in warmer and darker light,
/// and on another way of the camera; "office-again" has its way and light, and no change. "kitchen"
/// has 15 things of the office. "patrol" is a round like that of "loop", sparsely furnished, in
/// which things are moved between the laps. In "hall" (8 m x 12 m) surfaces are mostly 3 to 6 m
/// from the camera, in "kitchen" 1 to 3 m; "hallway" is 1.8 m wide and bare, but for its doors.
/// "sphere" (radius 0.5 m at the origin), "plane" (z = 0, 4 m x 4 m) and "box-room" are small, for
/// tests. In "wall", "floor" and "corridor" the camera sees nothing else, so camera motion along
/// the surface is unobservable from depth; in "wall-visit" the camera pans from some objects to the
/// bare wall and back. The last four also exist as
/// "...-plain", without texture.
const std::vector<std::string>& scene_names();

/// @throws std::invalid_argument naming the known scenes, if `name` is none of them
Scene make_scene(const std::string& name);

/// The same, with the path of the camera; `seed` is for the shake of the hand.
SceneWithPath make_scene_with_path(const std::string& name, std::uint32_t seed = 1);

/// Whether the scene is another one in each lap of its path.
bool changes_between_laps(const std::string& name);

/// The scene as it is in this lap of its path, from 0: things of "patrol" are moved between laps,
/// as `seed` says; the others stay the same.
Scene make_scene_in_lap(const std::string& name, std::uint32_t seed, int lap);

}  // namespace kintsugi::synthetic

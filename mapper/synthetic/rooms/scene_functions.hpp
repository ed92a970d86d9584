#pragma once
// The functions behind make_scene_with_path(), one for each scene.

#include <cstdint>

#include "mapper/synthetic/rooms/scene_with_path.hpp"

namespace kintsugi::synthetic {

SceneWithPath sphere_scene(std::uint32_t seed);
SceneWithPath plane_scene(std::uint32_t seed);
SceneWithPath box_room_scene(std::uint32_t seed);
SceneWithPath office_scene(std::uint32_t seed);
SceneWithPath office_again_scene(std::uint32_t seed);
SceneWithPath office_later_scene(std::uint32_t seed);
SceneWithPath loop_scene(std::uint32_t seed);
SceneWithPath patrol_scene(std::uint32_t seed);
SceneWithPath two_floors_scene(std::uint32_t seed);
SceneWithPath hall_scene(std::uint32_t seed);
SceneWithPath hallway_scene(std::uint32_t seed);
SceneWithPath kitchen_scene(std::uint32_t seed);

/// "patrol" in its lap number `lap`, from 0.
Scene patrol_scene_in(int lap, std::uint32_t seed);

SceneWithPath wall_scene(bool is_textured, std::uint32_t seed);
SceneWithPath floor_scene(bool is_textured, std::uint32_t seed);
SceneWithPath corridor_scene(bool is_textured, std::uint32_t seed);
SceneWithPath wall_visit_scene(bool is_textured, std::uint32_t seed);

}  // namespace kintsugi::synthetic

#include "mapper/synthetic/rooms/scenes.hpp"

#include <functional>
#include <map>
#include <stdexcept>

#include "mapper/synthetic/rooms/scene_functions.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr char kPatrol[] = "patrol";

using Maker = std::function<SceneWithPath(std::uint32_t)>;
using SurfaceMaker = SceneWithPath (*)(bool is_textured, std::uint32_t seed);

Maker with_texture(SurfaceMaker make) {
  return [make](std::uint32_t seed) { return make(true, seed); };
}

Maker without_texture(SurfaceMaker make) {
  return [make](std::uint32_t seed) { return make(false, seed); };
}

const std::map<std::string, Maker>& makers() {
  static const std::map<std::string, Maker> kMakers = {
      {"loop", loop_scene},
      {"office", office_scene},
      {"office-again", office_again_scene},
      {"office-later", office_later_scene},
      {kPatrol, patrol_scene},
      {"two-floors", two_floors_scene},
      {"hall", hall_scene},
      {"hallway", hallway_scene},
      {"kitchen", kitchen_scene},
      {"sphere", sphere_scene},
      {"plane", plane_scene},
      {"box-room", box_room_scene},
      {"wall", with_texture(wall_scene)},
      {"wall-plain", without_texture(wall_scene)},
      {"floor", with_texture(floor_scene)},
      {"floor-plain", without_texture(floor_scene)},
      {"corridor", with_texture(corridor_scene)},
      {"corridor-plain", without_texture(corridor_scene)},
      {"wall-visit", with_texture(wall_visit_scene)},
      {"wall-visit-plain", without_texture(wall_visit_scene)},
  };
  return kMakers;
}

}  // namespace

const std::vector<std::string>& scene_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const auto& [name, maker] : makers()) names.push_back(name);
    return names;
  }();
  return kNames;
}

SceneWithPath make_scene_with_path(const std::string& name, std::uint32_t seed) {
  const auto maker = makers().find(name);
  if (maker == makers().end()) {
    std::string message = "no synthetic scene \"" + name + "\"; there are:";
    for (const std::string& known : scene_names()) message += " " + known;
    throw std::invalid_argument(message);
  }
  return maker->second(seed);
}

Scene make_scene(const std::string& name) { return make_scene_with_path(name).scene; }

bool changes_between_laps(const std::string& name) { return name == kPatrol; }

Scene make_scene_in_lap(const std::string& name, std::uint32_t seed, int lap) {
  if (changes_between_laps(name)) return patrol_scene_in(lap, seed);
  return make_scene_with_path(name, seed).scene;
}

}  // namespace kintsugi::synthetic

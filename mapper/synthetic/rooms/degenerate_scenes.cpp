// Views whose geometry leaves directions of the camera's motion open: a wall and a floor (two
// translations and a rotation), a long corridor (one translation). Each with a texture that tells
// what geometry does not, and plain, where nothing does.
#include <string>

#include "mapper/synthetic/rooms/scene_functions.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr double kThickness_m = 0.2;

Material brick_or_plain(bool is_textured) {
  return is_textured ? textured(Texture::kBrick, rgb(178, 96, 72), rgb(214, 204, 190), 0.22)
                     : plain(rgb(214, 204, 190));
}

Material wood_or_plain(bool is_textured) {
  return is_textured ? textured(Texture::kWood, rgb(168, 120, 80), rgb(104, 70, 44), 0.14)
                     : plain(rgb(150, 140, 130));
}

/// Its surface is at y = 0 and looks along -y; no end of it comes into view.
void add_long_wall(SceneBuilder& builder, bool is_textured) {
  builder.add_structure("wall", at(0, kThickness_m / 2, 0), box(16, kThickness_m, 12),
                        brick_or_plain(is_textured));
}

Trajectory along(const std::vector<Waypoint>& waypoints, double duration_s, std::uint32_t seed) {
  return Trajectory(waypoints, {.duration_s = duration_s, .seed = seed});
}

}  // namespace

SceneWithPath wall_scene(bool is_textured, std::uint32_t seed) {
  SceneBuilder builder;
  add_long_wall(builder, is_textured);
  return {std::move(builder).build(), along({{{-0.6, -1.4, 0.0}, {-0.5, 0, -0.1}},
                                             {{-0.1, -1.5, 0.2}, {-0.1, 0, 0.1}},
                                             {{0.4, -1.4, 0.1}, {0.3, 0, 0.0}}},
                                            4.0, seed)};
}

SceneWithPath floor_scene(bool is_textured, std::uint32_t seed) {
  SceneBuilder builder;
  builder.add_structure("floor", at(0, 0, -kThickness_m / 2), box(16, 12, kThickness_m),
                        wood_or_plain(is_textured));
  return {std::move(builder).build(), along({{{-0.6, -0.9, 1.3}, {-0.5, 0, 0}},
                                             {{-0.1, -0.7, 1.4}, {-0.1, 0.2, 0}},
                                             {{0.4, -0.8, 1.3}, {0.3, 0.1, 0}}},
                                            4.0, seed)};
}

SceneWithPath corridor_scene(bool is_textured, std::uint32_t seed) {
  constexpr double kLength_m = 24.0;
  constexpr double kWidth_m = 1.7;
  constexpr double kHeight_m = 2.4;
  SceneBuilder builder;
  builder.add_structure("floor", at(0, 0, -kThickness_m / 2),
                        box(kLength_m, kWidth_m, kThickness_m), wood_or_plain(is_textured));
  builder.add_structure("ceiling", at(0, 0, kHeight_m + kThickness_m / 2),
                        box(kLength_m, kWidth_m, kThickness_m), plain(rgb(240, 240, 235)));
  for (const double side : {-1.0, 1.0}) {
    builder.add_structure("wall", at(0, side * (kWidth_m + kThickness_m) / 2, kHeight_m / 2),
                          box(kLength_m, kThickness_m, kHeight_m), brick_or_plain(is_textured));
  }
  return {std::move(builder).build(), along({{{-1.0, 0.05, 1.4}, {1.0, 0.0, 1.0}},
                                             {{-0.1, -0.1, 1.45}, {1.9, 0.1, 1.0}},
                                             {{0.8, 0.05, 1.4}, {2.8, 0.0, 1.0}}},
                                            5.0, seed)};
}

SceneWithPath wall_visit_scene(bool is_textured, std::uint32_t seed) {
  SceneBuilder builder;
  add_long_wall(builder, is_textured);
  builder.add_object("carton", at(-2.0, -0.25, -0.2, 0.5), box(0.5, 0.35, 0.4),
                     plain(rgb(186, 146, 98)));
  builder.add_object("ball", at(-1.5, -0.2, 0.35), sphere(0.18), plain(rgb(190, 60, 50)));
  builder.add_object("shelf", at(-2.0, -0.12, 0.45), box(0.6, 0.24, 0.04), plain(rgb(120, 90, 60)));
  const Waypoint things{{-1.8, -1.5, 0.1}, {-1.8, 0, 0.05}};
  return {std::move(builder).build(), along({things,
                                             {{-1.3, -1.4, 0.15}, {-1.2, 0, 0.1}},
                                             {{-0.4, -1.3, 0.1}, {-0.1, 0, 0.1}},
                                             {{-0.3, -1.35, 0.0}, {0.0, 0, 0.05}},
                                             {{-1.2, -1.45, 0.05}, {-1.2, 0, 0.05}},
                                             {{-1.75, -1.5, 0.12}, {-1.75, 0, 0.06}}},
                                            7.6, seed)};
}

}  // namespace kintsugi::synthetic

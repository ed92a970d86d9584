// Scenes with distances a person can work out, for tests.
#include "mapper/synthetic/rooms/scene_functions.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

SceneWithPath sphere_scene(std::uint32_t seed) {
  SceneBuilder builder;
  builder.add_object("sphere", at(0, 0, 0), sphere(0.5),
                     textured(Texture::kChecks, rgb(200, 80, 60), rgb(240, 220, 190), 0.1));
  const Eigen::Vector3d centre(0, 0, 0);
  return {std::move(builder).build(), Trajectory({{{1.4, 0, 0.3}, centre},
                                                  {{1.0, 1.0, 0.5}, centre},
                                                  {{0, 1.4, 0.2}, centre},
                                                  {{-1.0, 1.0, -0.3}, centre},
                                                  {{-1.4, 0, 0}, centre}},
                                                 {.duration_s = 20, .seed = seed})};
}

SceneWithPath plane_scene(std::uint32_t seed) {
  SceneBuilder builder;
  builder.add_structure("plane", at(0, 0, -0.25), box(4, 4, 0.5),
                        textured(Texture::kTiles, rgb(180, 180, 170), rgb(90, 90, 90), 0.25));
  return {std::move(builder).build(), Trajectory({{{-0.6, -0.5, 1.2}, {0, 0, 0}},
                                                  {{0, -0.7, 1.3}, {0.1, 0, 0}},
                                                  {{0.6, -0.5, 1.2}, {0, 0.1, 0}}},
                                                 {.duration_s = 6, .seed = seed})};
}

SceneWithPath box_room_scene(std::uint32_t seed) {
  SceneBuilder builder;
  const Material wall = textured(Texture::kPlaster, rgb(225, 215, 190), rgb(0, 0, 0), 0.15);
  builder.add_structure("floor", at(0, 0, -0.1), box(4.4, 4.4, 0.2),
                        textured(Texture::kWood, rgb(150, 105, 70), rgb(110, 75, 50), 0.12));
  builder.add_structure("ceiling", at(0, 0, 2.6), box(4.4, 4.4, 0.2), plain(rgb(240, 240, 235)));
  builder.add_structure("wall", at(2.1, 0, 1.25), box(0.2, 4.4, 2.5), wall);
  builder.add_structure("wall", at(-2.1, 0, 1.25), box(0.2, 4.4, 2.5), wall);
  builder.add_structure("wall", at(0, 2.1, 1.25), box(4.0, 0.2, 2.5), wall);
  builder.add_structure("wall", at(0, -2.1, 1.25), box(4.0, 0.2, 2.5), wall);
  builder.add_object("red box", at(1.5, 0.8, 0.4, 0.3), box(0.6, 0.5, 0.8),
                     plain(rgb(190, 50, 45)));
  builder.add_object("blue box", at(1.5, 0.8, 0.95, 0.8), box(0.3, 0.3, 0.3),
                     plain(rgb(50, 80, 180)));
  builder.add_object("green box", at(0.9, -1.3, 0.25, 0.6), box(0.5, 0.5, 0.5),
                     plain(rgb(60, 150, 70)));
  builder.add_object("ball", at(1.6, -0.3, 0.2), sphere(0.2), plain(rgb(230, 160, 40)));
  builder.add_structure("pillar", at(-1.4, 1.4, 1.25), cylinder(0.2, 2.5), wall);
  return {std::move(builder).build(), Trajectory({{{-1.2, -0.6, 1.3}, {1.4, 0.3, 0.6}},
                                                  {{-0.7, -0.2, 1.35}, {1.4, 0.3, 0.6}},
                                                  {{-0.6, 0.4, 1.3}, {1.4, -0.2, 0.5}},
                                                  {{-0.9, 0.7, 1.4}, {1.2, -0.6, 0.5}}},
                                                 {.duration_s = 8, .seed = seed})};
}

}  // namespace kintsugi::synthetic

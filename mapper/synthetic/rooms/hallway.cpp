// A corridor with nothing in it, 1.8 m wide: doors on both sides, and after 11.5 m a bend to the
// left. Doors, their frames and the end wall determine where the camera is.
//
//                                  4.5 +-door-+
//   y                                  |      |
//   0.9  ---door---door----door----door+      |
//   0                camera ->            end |
//  -0.9  -----door----door----door--------door+
//        x = 0                        9.7    11.5
#include <numbers>

#include "mapper/synthetic/rooms/room_shell.hpp"
#include "mapper/synthetic/rooms/scene_functions.hpp"
#include "mapper/synthetic/rooms/walk.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kWidth_m = 1.8;
constexpr double kHalf_m = kWidth_m / 2;
constexpr double kLength_m = 11.5;
constexpr double kBendStart_m = kLength_m - kWidth_m;
constexpr double kBranchEnd_m = 4.5;
constexpr double kAxis_m = kHalf_m + kWallThickness_m / 2;  // of the long walls

const Material kWall = textured(Texture::kPlaster, rgb(224, 220, 206), rgb(0, 0, 0), 0.14);
const Material kEndWall = textured(Texture::kPlaster, rgb(172, 188, 196), rgb(0, 0, 0), 0.14);
const Material kFloor = textured(Texture::kTiles, rgb(150, 146, 138), rgb(96, 92, 88), 0.45);
const Material kCeiling = plain(rgb(242, 242, 238));

Opening closed_door(double middle_m, double width_m = 0.95) {
  return {.middle_m = middle_m, .width_m = width_m, .has_door_leaf = true};
}

void add_walls(SceneBuilder& builder) {
  const double half_wall = kWallThickness_m / 2;
  const double end = kLength_m + half_wall;
  const double branch_end = kBranchEnd_m + half_wall;
  const double branch_axis = kBendStart_m - half_wall;
  add_wall(builder, {0, kAxis_m, 0}, {kBendStart_m, kAxis_m, 0}, kWall,
           {closed_door(1.2), closed_door(3.3), closed_door(6.1), closed_door(8.35)});
  add_wall(builder, {0, -kAxis_m, 0}, {end, -kAxis_m, 0}, kWall,
           {closed_door(2.2), closed_door(4.7), closed_door(7.3, 1.4), closed_door(9.35)});
  add_wall(builder, {-half_wall, -kAxis_m, 0}, {-half_wall, kAxis_m, 0}, kEndWall,
           {closed_door(kAxis_m)});
  add_wall(builder, {end, -kAxis_m, 0}, {end, branch_end, 0}, kEndWall,
           {closed_door(0.85), closed_door(3.9)});
  add_wall(builder, {branch_axis, kAxis_m, 0}, {branch_axis, branch_end, 0}, kWall,
           {closed_door(2.1)});
  add_wall(builder, {branch_axis, branch_end, 0}, {end, branch_end, 0}, kEndWall,
           {closed_door(kHalf_m + half_wall)});
}

void add_lamps(SceneBuilder& builder) {
  for (const double x : {1.6, 4.1, 6.6, 9.1}) {
    builder.add_structure("lamp", at(x, 0, kRoomHeight_m - 0.04), box(1.2, 0.28, 0.08),
                          plain(rgb(252, 250, 240)));
  }
  builder.add_structure("lamp", at(kLength_m - kHalf_m, 2.7, kRoomHeight_m - 0.04),
                        box(0.28, 1.2, 0.08), plain(rgb(252, 250, 240)));
}

/// The name of a room, on the wall beside its door.
void add_door_sign(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_structure("door sign", X_WG);
  builder.add(box(0.20, 0.012, 0.14), at(0, -0.006, 0),
              textured(Texture::kScreen, rgb(238, 238, 232), rgb(40, 60, 110), 0.01));
}

void add_door_signs(SceneBuilder& builder) {
  constexpr double kHeight_m = 1.55;
  for (const double x : {2.0, 4.1, 6.9, 9.15}) {
    add_door_sign(builder, at(x, kHalf_m, kHeight_m));
  }
  for (const double x : {1.4, 3.9, 6.2, 8.55}) {
    add_door_sign(builder, at(x, -kHalf_m, kHeight_m, kPi));
  }
  add_door_sign(builder, at(kLength_m, 0.75, kHeight_m, -kPi / 2));
}

}  // namespace

SceneWithPath hallway_scene(std::uint32_t seed) {
  SceneBuilder builder;
  add_slab(builder, "floor", {-0.2, -kAxis_m}, {kLength_m + 0.2, kBranchEnd_m + 0.2}, 0, kFloor);
  add_slab(builder, "ceiling", {-0.2, -kAxis_m}, {kLength_m + 0.2, kBranchEnd_m + 0.2},
           kRoomHeight_m + 0.2, kCeiling);
  add_walls(builder);
  add_lamps(builder);
  add_door_signs(builder);

  constexpr double kPitch_deg = -9.0;
  Walk walk({7.0, -0.10, 0}, -18, kPitch_deg);
  walk.to({7.7, 0.08, 0}, 22, kPitch_deg - 3)
      .to({8.5, -0.05, 0}, -16, kPitch_deg)
      .to({9.3, -0.05, 0}, 16, kPitch_deg - 4)
      .to({10.0, 0.10, 0}, 58, kPitch_deg);
  return {std::move(builder).build(),
          Trajectory(walk.waypoints(), {.duration_s = 10, .seed = seed})};
}

}  // namespace kintsugi::synthetic

// A hall of 8 m x 12 m, 3.7 m high, as in a school or a station: columns, beams, tables, and
// benches along the walls. The camera stays in the middle, so that most of what it sees is 3 to 6 m
// away.
#include <numbers>

#include "mapper/synthetic/rooms/furniture.hpp"
#include "mapper/synthetic/rooms/room_shell.hpp"
#include "mapper/synthetic/rooms/scene_functions.hpp"
#include "mapper/synthetic/rooms/small_objects.hpp"
#include "mapper/synthetic/rooms/storage_things.hpp"
#include "mapper/synthetic/rooms/walk.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kHalfX_m = 4.0;
constexpr double kHalfY_m = 6.0;
constexpr double kHeight_m = 3.7;

const Material kWall = textured(Texture::kPlaster, rgb(226, 216, 194), rgb(0, 0, 0), 0.15);
const Material kBrick = textured(Texture::kBrick, rgb(172, 98, 76), rgb(210, 200, 186), 0.24);
const Material kFloor = textured(Texture::kChecks, rgb(188, 180, 164), rgb(150, 140, 126), 0.60);
const Material kStone = textured(Texture::kPlaster, rgb(198, 192, 180), rgb(0, 0, 0), 0.05);
const Material kBeam = textured(Texture::kWood, rgb(128, 84, 54), rgb(98, 62, 40), 0.16);

Opening high_window(double middle_m) {
  return {.middle_m = middle_m, .width_m = 1.3, .bottom_m = 1.0, .top_m = 3.0};
}

void add_shell(SceneBuilder& builder) {
  const double x = kHalfX_m + kWallThickness_m / 2;
  const double y = kHalfY_m + kWallThickness_m / 2;
  add_slab(builder, "floor", {-x, -y}, {x, y}, 0, kFloor);
  add_slab(builder, "ceiling", {-x, -y}, {x, y}, kHeight_m + 0.2, plain(rgb(240, 238, 230)));
  add_wall(builder, {-x, y, 0}, {x, y, 0}, kBrick, {high_window(2.0), high_window(6.6)}, kHeight_m);
  add_wall(builder, {x, y, 0}, {x, -y, 0}, kWall,
           {high_window(3.4),
            high_window(6.7),
            {.middle_m = 8.2, .width_m = 1.0, .has_door_leaf = true}},
           kHeight_m);
  add_wall(builder, {x, -y, 0}, {-x, -y, 0}, kBrick,
           {{.middle_m = 4.06, .width_m = 1.8, .has_door_leaf = true}}, kHeight_m);
  add_wall(builder, {-x, -y, 0}, {-x, y, 0}, kWall,
           {{.middle_m = 3.2, .width_m = 1.0, .has_door_leaf = true}}, kHeight_m);
  for (int i = -2; i <= 2; ++i) {
    builder.add_structure("beam", at(0, 2.4 * i, kHeight_m - 0.15), box(2 * kHalfX_m, 0.24, 0.30),
                          kBeam);
  }
}

void add_column(SceneBuilder& builder, double x, double y) {
  constexpr double kTop_m = kHeight_m - 0.30;  // below the beam
  builder.begin_structure("column", at(x, y, 0));
  builder.add(cylinder(0.20, kTop_m), at(0, 0, kTop_m / 2), kStone);
  builder.add(box(0.60, 0.60, 0.25), at(0, 0, 0.125), kStone);
  builder.add(cone(0.20, 0.32, 0.25), at(0, 0, kTop_m - 0.125), kStone);
  builder.add(torus(0.22, 0.05), at(0, 0, 0.30), kStone);
}

void add_ceiling_lamp(SceneBuilder& builder, double x, double y) {
  builder.begin_object("ceiling lamp", at(x, y, kHeight_m));
  builder.add(cone(0.28, 0.08, 0.22), at(0, 0, -0.86), plain(rgb(60, 96, 90)));
  builder.add(sphere(0.09), at(0, 0, -0.96), plain(rgb(252, 244, 210)));
  builder.add(cylinder(0.012, 0.80), at(0, 0, -0.40), plain(rgb(40, 40, 44)));
}

/// A table with chairs along its sides and things on it; G is on the floor below its middle.
void add_laid_table(SceneBuilder& builder, const Pose& X_WG, CounterRandom& random) {
  constexpr double kWidth_m = 1.8;
  constexpr double kDepth_m = 0.8;
  add_table(builder, X_WG, kWidth_m, kDepth_m);
  for (const double x : {-0.45, 0.45}) {
    add_chair(builder, X_WG * at(x, 0.62, 0, random.uniform(-0.3, 0.3)), any_color(random));
    add_chair(builder, X_WG * at(x, -0.62, 0, kPi + random.uniform(-0.3, 0.3)), any_color(random));
  }
  for (const double x : {-0.65, -0.1, 0.5}) {
    add_any_small_object(builder, X_WG * at(x, random.uniform(-0.15, 0.15), kTableHeight_m),
                         random);
  }
}

void add_tables(SceneBuilder& builder, CounterRandom& random) {
  add_laid_table(builder, at(2.7, -1.6, 0, kPi / 2), random);
  add_laid_table(builder, at(2.65, 1.5, 0, kPi / 2 + 0.1), random);
  add_laid_table(builder, at(1.2, 4.3, 0, 0.1), random);
  add_laid_table(builder, at(-2.6, 0.6, 0, kPi / 2), random);
  add_round_table(builder, at(-1.6, 3.9, 0), 0.55, kTableHeight_m);
  add_bowl(builder, at(-1.6, 3.9, kTableHeight_m), rgb(226, 222, 210));
  add_stool(builder, at(-0.9, 3.6, 0), rgb(60, 110, 160));
  add_round_table(builder, at(1.3, -4.2, 0), 0.55, kTableHeight_m);
  add_vase(builder, at(1.3, -4.2, kTableHeight_m), rgb(160, 70, 60));
  add_stool(builder, at(0.6, -4.5, 0), rgb(180, 120, 50));
}

// G is on the floor at the foot of a wall and looks away from it.

void add_seat(SceneBuilder& builder, const Pose& X_WG, CounterRandom& random) {
  add_bench(builder, X_WG * at(0, -0.28, 0), 1.6);
  add_backpack(builder, X_WG * at(-0.4, -0.24, 0.46), any_color(random));
  add_picture(builder, X_WG * at(0, 0, 1.75), 1.2, 0.9, any_color(random), any_color(random));
}

void add_cabinet_with_plant(SceneBuilder& builder, const Pose& X_WG, CounterRandom& random) {
  add_cabinet(builder, X_WG * at(0, -0.24, 0), 1.1, any_color(random));
  add_any_small_object(builder, X_WG * at(-0.25, -0.24, kCabinetHeight_m), random);
  add_any_small_object(builder, X_WG * at(0.25, -0.24, kCabinetHeight_m), random);
  add_plant(builder, X_WG * at(0.95, -0.40, 0), 1.3);
}

void add_wall_things(SceneBuilder& builder, CounterRandom& random) {
  const auto east = [](double y, double z = 0) { return at(kHalfX_m, y, z, -kPi / 2); };
  const auto west = [](double y, double z = 0) { return at(-kHalfX_m, y, z, kPi / 2); };
  const auto north = [](double x, double z = 0) { return at(x, kHalfY_m, z); };
  const auto south = [](double x, double z = 0) { return at(x, -kHalfY_m, z, kPi); };
  for (const double y : {4.7, 0.9, -4.2}) add_seat(builder, east(y), random);
  for (const double y : {3.0, -0.6}) add_cabinet_with_plant(builder, east(y), random);
  add_clock(builder, east(-2.2, 2.75));
  add_fire_extinguisher(builder, east(-2.95));
  for (const double y : {5.0, -0.9}) add_seat(builder, west(y), random);
  for (const double y : {2.9, -4.6}) add_cabinet_with_plant(builder, west(y), random);
  add_whiteboard(builder, west(1.2, 1.6), 1.8);
  add_seat(builder, north(0.2), random);
  add_cabinet_with_plant(builder, north(2.4), random);
  add_clock(builder, north(0.2, 2.7));
  add_seat(builder, south(-2.4), random);
  add_cabinet_with_plant(builder, south(2.6), random);
  add_traffic_cone(builder, at(3.2, -3.2, 0));
  add_carton(builder, at(3.2, 0.05, 0, 0.3), {0.6, 0.45, 0.5});
  add_coat_rack(builder, at(-3.5, -5.5, 0, 0.8));
}

}  // namespace

SceneWithPath hall_scene(std::uint32_t seed) {
  SceneBuilder builder;
  CounterRandom random(8);
  add_shell(builder);
  for (const double x : {-2.0, 1.75}) {
    for (const double y : {-2.4, 2.4}) add_column(builder, x, y);
  }
  for (const double y : {-3.6, 0.0, 3.6}) {
    add_ceiling_lamp(builder, -1.8, y);
    add_ceiling_lamp(builder, 1.8, y);
  }
  add_tables(builder, random);
  add_wall_things(builder, random);

  constexpr double kPitch_deg = -3.0;
  Walk walk({-0.45, -1.4, 0}, 16, kPitch_deg);
  walk.to({-0.40, -0.5, 0}, -28, kPitch_deg - 4)
      .to({-0.30, 0.5, 0}, 18, kPitch_deg)
      .to({-0.10, 1.4, 0}, -32, kPitch_deg - 3);
  return {std::move(builder).build(),
          Trajectory(walk.waypoints(), {.duration_s = 10, .seed = seed})};
}

}  // namespace kintsugi::synthetic

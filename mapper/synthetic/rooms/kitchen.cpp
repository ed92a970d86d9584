// A kitchen of 3.8 m x 3.4 m: counters with sink and stove along the back wall, cupboards above, a
// table with small things. What the camera sees is 1 to 3 m away.
#include <numbers>
#include <utility>

#include "mapper/synthetic/rooms/desk_things.hpp"
#include "mapper/synthetic/rooms/furniture.hpp"
#include "mapper/synthetic/rooms/kitchen_things.hpp"
#include "mapper/synthetic/rooms/room_shell.hpp"
#include "mapper/synthetic/rooms/scene_functions.hpp"
#include "mapper/synthetic/rooms/small_objects.hpp"
#include "mapper/synthetic/rooms/storage_things.hpp"
#include "mapper/synthetic/rooms/walk.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kHalfX_m = 1.9;
constexpr double kHalfY_m = 1.7;
constexpr double kCounterInset_m = 0.33;  // from the wall to the middle of a counter

void add_shell(SceneBuilder& builder) {
  const Material wall = textured(Texture::kPlaster, rgb(232, 224, 190), rgb(0, 0, 0), 0.12);
  const double x = kHalfX_m + kWallThickness_m / 2;
  const double y = kHalfY_m + kWallThickness_m / 2;
  add_slab(builder, "floor", {-x, -y}, {x, y}, 0,
           textured(Texture::kTiles, rgb(196, 150, 116), rgb(130, 112, 100), 0.30));
  add_slab(builder, "ceiling", {-x, -y}, {x, y}, kRoomHeight_m + 0.2, plain(rgb(244, 244, 240)));
  add_wall(builder, {-x, y, 0}, {x, y, 0}, wall,
           {{.middle_m = 2.15, .width_m = 1.0, .bottom_m = 1.15, .top_m = 2.15}});
  add_wall(builder, {x, y, 0}, {x, -y, 0}, wall);
  add_wall(builder, {x, -y, 0}, {-x, -y, 0}, wall,
           {{.middle_m = 1.0, .width_m = 0.9, .has_door_leaf = true}});
  add_wall(builder, {-x, -y, 0}, {-x, y, 0}, wall);
  builder.add_structure("wall tiles", at(-1.155, kHalfY_m - 0.004, 1.18), box(1.49, 0.016, 0.56),
                        textured(Texture::kTiles, rgb(216, 226, 226), rgb(150, 156, 158), 0.14));
}

/// From the left: a counter, the stove, the sink below the window, the fridge.
void add_back_wall(SceneBuilder& builder) {
  const auto place = [](double x, double z = 0) { return at(x, kHalfY_m - kCounterInset_m, z); };
  const auto on_top = [&](double x, double y, double yaw_rad = 0) {
    return place(x, kCounterHeight_m) * at(0, y, 0, yaw_rad);
  };
  add_counter(builder, place(-1.55), 0.66);
  add_toaster(builder, on_top(-1.62, 0.10, 0.2));
  add_tin(builder, on_top(-1.36, 0.20), rgb(60, 120, 80));
  add_tin(builder, on_top(-1.36, 0.10), rgb(186, 60, 50));
  add_stove(builder, place(-0.91));
  add_cooking_pot(builder, on_top(-1.05, 0.14, 0.4), rgb(196, 60, 50));
  add_teapot(builder, on_top(-0.77, -0.12, -0.5), rgb(46, 92, 178));
  add_sink_counter(builder, place(0.28), 1.74);
  add_paper_roll(builder, on_top(-0.48, 0.18));
  add_chopping_board(builder, on_top(-0.33, -0.10, 0.15));
  add_dish_rack(builder, on_top(0.82, 0.08, -0.1));
  add_bottle(builder, on_top(0.50, 0.22), rgb(230, 120, 40));
  add_fridge(builder, at(1.54, kHalfY_m - 0.36, 0));

  add_wall_cupboard(builder, at(-1.56, kHalfY_m, 1.46), 0.66);
  add_extractor_hood(builder, at(-0.91, kHalfY_m, 1.55));
  add_wall_cupboard(builder, at(-0.46, kHalfY_m, 1.46), 0.26);
}

void add_table_things(SceneBuilder& builder, CounterRandom& random) {
  const Pose X_WG = at(-1.02, -0.25, 0, 0.12);
  const Pose X_WT = X_WG * at(0, 0, kTableHeight_m);
  add_table(builder, X_WG, 1.15, 0.80);
  add_plate(builder, X_WT * at(-0.28, -0.20, 0), rgb(238, 236, 226));
  add_plate(builder, X_WT * at(0.30, 0.18, 0), rgb(238, 236, 226));
  add_mug(builder, X_WT * at(0.36, -0.02, 0, 0.7), rgb(238, 236, 226));
  add_mug(builder, X_WT * at(-0.10, -0.25, 0, -0.9), rgb(46, 92, 178));
  add_bowl(builder, X_WT * at(-0.02, 0.08, 0), rgb(120, 150, 140));
  add_bottle(builder, X_WT * at(0.10, 0.27, 0), rgb(60, 110, 60));
  add_jar(builder, X_WT * at(-0.36, 0.16, 0), 0.13, rgb(226, 190, 110));
  add_book(builder, X_WT * at(0.28, -0.24, 0, 0.3), {0.22, 0.15, 0.03}, rgb(126, 60, 150));
  add_vase(builder, X_WT * at(-0.24, 0.26, 0), rgb(70, 130, 140));
  add_chair(builder, X_WG * at(0.15, -0.62, 0, kPi + 0.25), any_color(random));
  add_chair(builder, X_WG * at(-0.25, 0.62, 0, -0.2), any_color(random));
}

void add_other_walls(SceneBuilder& builder, CounterRandom& random) {
  add_wall_shelf(builder, at(-kHalfX_m, -0.2, 1.50, kPi / 2), 1.1, random);
  add_clock(builder, at(-kHalfX_m, 0.70, 1.85, kPi / 2));
  add_plant(builder, at(-1.60, -1.38, 0), 0.9);
  add_cabinet(builder, at(1.66, 0.35, 0, -kPi / 2), 0.9, rgb(178, 130, 84));
  add_bowl(builder, at(1.66, 0.55, kCabinetHeight_m), rgb(226, 120, 60));
  add_carton(builder, at(1.66, 0.15, kCabinetHeight_m, 0.2), {0.26, 0.2, 0.22});
  add_picture(builder, at(kHalfX_m, 0.35, 1.55, -kPi / 2), 0.6, 0.5, rgb(70, 130, 80),
              rgb(240, 214, 140));
  add_bin(builder, at(1.62, -0.40, 0), rgb(120, 126, 132));
  add_bookcase(builder, at(1.74, -1.0, 0, -kPi / 2), 0.7, 1.5, random);
  add_picture(builder, at(-0.8, -kHalfY_m, 1.5, kPi), 0.8, 0.6, rgb(200, 90, 60),
              rgb(240, 230, 200));
}

/// A side table at the entrance; its front is towards the room.
void add_office_things_on_side_table(SceneBuilder& builder) {
  const Pose X_WG = at(-0.55, -1.40, 0, kPi);
  const Pose X_WT = X_WG * at(0, 0, kTableHeight_m);
  add_table(builder, X_WG, 1.2, 0.5);
  add_teapot(builder, X_WT * at(-0.47, 0.06, 0, 1.9), rgb(226, 190, 60));
  add_storage_box(builder, X_WT * at(-0.26, 0.11, 0, -0.1), {0.22, 0.20, 0.16},
                  plain(rgb(90, 130, 170)));
  add_carton(builder, X_WT * at(-0.02, 0.13, 0, 0.2), {0.20, 0.15, 0.11});
  add_globe(builder, X_WT * at(0.20, 0.13, 0));
  add_desk_lamp(builder, X_WT * at(0.48, 0.10, 0, 0.3), rgb(48, 140, 84));
  add_keyboard(builder, X_WT * at(-0.30, -0.13, 0, 0.08));
  add_phone(builder, X_WT * at(0.08, -0.13, 0, -0.2));
  add_binder(builder, X_WT * at(0.34, -0.10, 0, 0.3), rgb(186, 66, 58));
}

/// Things of the office, as they are there.
void add_office_things(SceneBuilder& builder) {
  add_office_things_on_side_table(builder);
  const Pose X_WT = at(-1.02, -0.25, kTableHeight_m, 0.12);
  add_mug(builder, X_WT * at(0.12, -0.14, 0, 2.0), rgb(206, 44, 44));
  add_stapler(builder, X_WT * at(0.50, 0.02, 0, 1.4));
  const auto on_counter = [](double x, double y, double yaw_rad = 0) {
    return at(x, kHalfY_m - kCounterInset_m + y, kCounterHeight_m, yaw_rad);
  };
  add_tissue_box(builder, on_counter(-1.68, -0.17, 0.2));
  add_table_clock(builder, on_counter(-1.40, -0.14, -0.2));
  add_bottle(builder, on_counter(-0.07, 0.20), rgb(40, 122, 150));
  add_toolbox(builder, on_counter(0.86, -0.20, 0.1), rgb(60, 110, 70));
  add_carton(builder, at(-0.05, 0.80, 0, 0.4), {0.34, 0.28, 0.24});
}

}  // namespace

SceneWithPath kitchen_scene(std::uint32_t seed) {
  SceneBuilder builder;
  CounterRandom random(5);
  add_shell(builder);
  add_back_wall(builder);
  add_table_things(builder, random);
  add_other_walls(builder, random);
  add_office_things(builder);

  Walk walk({0.20, -0.25, 0}, 238, -27);
  walk.to({0.55, -0.40, 0}, 220, -25)
      .to({0.85, -0.80, 0}, 195, -24)
      .to({0.55, -0.95, 0}, 172, -24)
      .to({0.20, -0.80, 0}, 140, -20)
      .to({0.30, -0.35, 0}, 105, -16)
      .to({0.60, -0.10, 0}, 70, -18)
      .to({0.75, -0.45, 0}, 110, -20)
      .to({0.70, -0.75, 0}, 140, -18);
  return {std::move(builder).build(),
          Trajectory(walk.waypoints(), {.duration_s = 14, .seed = seed})};
}

}  // namespace kintsugi::synthetic

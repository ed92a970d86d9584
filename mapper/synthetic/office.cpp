// A desk with everything on it, in a room of 4.2 m x 3.6 m.
#include "mapper/synthetic/furniture.hpp"
#include "mapper/synthetic/room_plans.hpp"
#include "mapper/synthetic/room_shell.hpp"
#include "mapper/synthetic/scene_builder.hpp"
#include "mapper/synthetic/small_objects.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kHalfX_m = 2.1;
constexpr double kHalfY_m = 1.8;

void add_room(SceneBuilder& builder) {
  const Material wall = textured(Texture::kPlaster, rgb(228, 220, 200), rgb(0, 0, 0), 0.12);
  const Material accent = textured(Texture::kBrick, rgb(178, 96, 72), rgb(214, 204, 190), 0.22);
  const double x = kHalfX_m + kWallThickness_m / 2;
  const double y = kHalfY_m + kWallThickness_m / 2;
  add_slab(builder, "floor", {-x, -y}, {x, y}, 0.0,
           textured(Texture::kCarpet, rgb(84, 100, 122), rgb(108, 124, 146), 0.012));
  add_slab(builder, "ceiling", {-x, -y}, {x, y}, kRoomHeight_m + 0.2, plain(rgb(244, 244, 240)));
  add_wall(builder, {-x, y, 0}, {x, y, 0}, wall,
           {{.middle_m = 1.05, .width_m = 0.8, .bottom_m = 1.0, .top_m = 2.1}});
  add_wall(builder, {x, y, 0}, {x, -y, 0}, accent);
  add_wall(builder, {x, -y, 0}, {-x, -y, 0}, wall,
           {{.middle_m = 2.9, .width_m = 0.85, .has_door_leaf = true}});
  add_wall(builder, {-x, -y, 0}, {-x, y, 0}, wall);
}

void add_desk_with_things(SceneBuilder& builder, CounterRandom& random) {
  const Pose X_WD = at(0.05, 1.38, 0);
  add_desk(builder, X_WD, 1.8, 0.78);
  const Pose X_WT = X_WD * at(0, 0, kDeskHeight_m);  // T: the middle of the desk's top
  add_monitor(builder, X_WT * at(-0.05, 0.20, 0, 0.1));
  add_keyboard(builder, X_WT * at(-0.05, -0.17, 0, 0.05));
  add_mouse(builder, X_WT * at(0.28, -0.17, 0, -0.15));
  add_mug(builder, X_WT * at(0.46, -0.12, 0, -0.5), rgb(206, 44, 44));
  add_book_stack(builder, X_WT * at(0.68, 0.12, 0, 0.2), 4, random);
  add_tape_roll(builder, X_WT * at(0.66, 0.12, 0.155), rgb(240, 200, 60));
  add_pen_holder(builder, X_WT * at(0.38, 0.14, 0), rgb(44, 84, 160));
  add_desk_lamp(builder, X_WT * at(-0.62, 0.22, 0, -0.4), rgb(48, 140, 84));
  add_plant(builder, X_WT * at(-0.80, 0.02, 0), 0.32);
  add_bottle(builder, X_WT * at(0.47, 0.29, 0), rgb(40, 122, 150));
  add_ball(builder, X_WT * at(-0.42, -0.02, 0), 0.055, rgb(238, 126, 34));
  add_phone(builder, X_WT * at(-0.58, -0.22, 0, 0.35));
  add_speaker(builder, X_WT * at(0.31, 0.29, 0));
  add_carton(builder, X_WT * at(0.70, -0.22, 0, -0.3), {0.20, 0.15, 0.11});
  add_carton(builder, X_WT * at(0.70, -0.22, 0.11, 0.25), {0.12, 0.10, 0.08});
  // A book that leans against the carton.
  add_book(builder,
           X_WT * at(0.553, -0.27, 0.0875, -0.3) *
               Pose(Eigen::AngleAxisd(-1.15, Eigen::Vector3d::UnitY())),
           {0.19, 0.14, 0.022}, rgb(126, 60, 150));
}

void add_furniture(SceneBuilder& builder, CounterRandom& random) {
  add_office_chair(builder, at(-0.15, 0.62, 0, kPi - 0.5), rgb(36, 62, 120));
  add_bookcase(builder, at(1.55, 1.64, 0), 0.95, 1.85, random);
  add_bin(builder, at(-1.10, 1.45, 0), rgb(120, 126, 132));
  add_carton(builder, at(-1.62, 1.40, 0, 0.15), {0.46, 0.36, 0.34});
  add_carton(builder, at(-1.60, 1.42, 0.34, -0.2), {0.34, 0.28, 0.24});
  add_globe(builder, at(-1.60, 1.42, 0.58));
  add_cabinet(builder, at(1.87, 0.55, 0, -kPi / 2), 0.80, rgb(206, 206, 196));
  add_plant(builder, at(1.87, 0.72, kCabinetHeight_m), 0.55);
  add_teapot(builder, at(1.84, 0.35, kCabinetHeight_m, 0.6), rgb(226, 190, 60));
  add_chair(builder, at(1.45, -0.55, 0, -0.9), rgb(176, 58, 50));
  add_backpack(builder, at(-1.80, 0.45, 0, -kPi / 2 - kPi), rgb(196, 88, 40));
  add_cabinet(builder, at(-1.88, -0.55, 0, kPi / 2), 0.9, rgb(120, 150, 140));
  add_bowl(builder, at(-1.86, -0.35, kCabinetHeight_m), rgb(236, 236, 230));
  add_bottle(builder, at(-1.88, -0.75, kCabinetHeight_m), rgb(120, 40, 60));
  add_sofa(builder, at(1.0, -1.38, 0, kPi), 1.5, rgb(70, 118, 108));
  add_coat_rack(builder, at(-1.75, -1.45, 0, 0.8));
}

void add_walls_things(SceneBuilder& builder, CounterRandom& random) {
  add_picture(builder, at(0.35, kHalfY_m, 1.72), 0.60, 0.44, rgb(236, 190, 70), rgb(40, 90, 150));
  add_clock(builder, at(0.92, kHalfY_m, 1.95));
  add_wall_shelf(builder, at(kHalfX_m, 0.45, 1.55, -kPi / 2), 0.9, random);
  add_picture(builder, at(-kHalfX_m, 0.55, 1.45, kPi / 2), 0.7, 0.5, rgb(60, 130, 120),
              rgb(240, 220, 180));
  add_radiator(builder, at(-kHalfX_m, 1.05, 0, kPi / 2), 0.6);
  add_whiteboard(builder, at(-kHalfX_m, -0.6, 1.5, kPi / 2), 1.2);
}

}  // namespace

SceneWithPath office_scene(std::uint32_t seed) {
  SceneBuilder builder;
  CounterRandom random(42);
  add_room(builder);
  add_desk_with_things(builder, random);
  add_furniture(builder, random);
  add_walls_things(builder, random);
  return {std::move(builder).build(), Trajectory({{{-1.05, 0.10, 1.40}, {-0.55, 1.40, 0.78}},
                                                  {{-0.60, -0.05, 1.42}, {-0.20, 1.40, 0.80}},
                                                  {{-0.15, -0.10, 1.36}, {-0.05, 1.40, 0.80}},
                                                  {{0.35, 0.00, 1.30}, {0.15, 1.40, 0.80}},
                                                  {{0.75, 0.15, 1.38}, {0.40, 1.40, 0.82}},
                                                  {{0.95, 0.10, 1.45}, {0.85, 1.50, 0.90}},
                                                  {{0.70, -0.20, 1.45}, {0.80, 1.50, 0.95}},
                                                  {{0.30, -0.35, 1.40}, {0.30, 1.40, 0.85}}},
                                                 {.duration_s = 12.49, .seed = seed})};
}

}  // namespace kintsugi::synthetic

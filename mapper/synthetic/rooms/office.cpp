// A desk with everything on it, in a room of 4.2 m x 3.6 m. What the camera sees is crowded: things
// touch, are stacked, lean, are thin, or have the colour of what they stand on.
#include "mapper/synthetic/rooms/office.hpp"

#include <utility>

#include "mapper/synthetic/rooms/desk_things.hpp"
#include "mapper/synthetic/rooms/furniture.hpp"
#include "mapper/synthetic/rooms/room_shell.hpp"
#include "mapper/synthetic/rooms/scene_functions.hpp"
#include "mapper/synthetic/rooms/small_objects.hpp"
#include "mapper/synthetic/rooms/storage_things.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kHalfX_m = 2.1;
constexpr double kHalfY_m = kOfficeBackWall_m;

const Color kWallColor = rgb(228, 220, 200);
const Pose kDesk = at(0.05, 1.38, 0);
const Material kCarpet = textured(Texture::kCarpet, rgb(84, 100, 122), rgb(108, 124, 146), 0.012);

void add_room(SceneBuilder& builder) {
  const Material wall = textured(Texture::kPlaster, kWallColor, rgb(0, 0, 0), 0.12);
  const Material accent = textured(Texture::kBrick, rgb(178, 96, 72), rgb(214, 204, 190), 0.22);
  const double x = kHalfX_m + kWallThickness_m / 2;
  const double y = kHalfY_m + kWallThickness_m / 2;
  add_slab(builder, "floor", {-x, -y}, {x, y}, 0.0, kCarpet);
  add_slab(builder, "ceiling", {-x, -y}, {x, y}, kRoomHeight_m + 0.2, plain(rgb(244, 244, 240)));
  add_wall(builder, {-x, y, 0}, {x, y, 0}, wall,
           {{.middle_m = 1.05, .width_m = 0.8, .bottom_m = 1.0, .top_m = 2.1}});
  add_wall(builder, {x, y, 0}, {x, -y, 0}, accent);
  add_wall(builder, {x, -y, 0}, {-x, -y, 0}, wall,
           {{.middle_m = 2.9, .width_m = 0.85, .has_door_leaf = true}});
  add_wall(builder, {-x, -y, 0}, {-x, y, 0}, wall);
}

// Of the three that follow, T is the middle of the desk's top.

void add_computer_things(SceneBuilder& builder, const Pose& X_WT) {
  add_monitor(builder, X_WT * at(-0.05, 0.20, 0, 0.1));
  add_keyboard(builder, X_WT * at(-0.05, -0.17, 0, 0.05));
  add_mouse_pad(builder, X_WT * at(0.29, -0.17, 0));
  add_mouse(builder, X_WT * at(0.28, -0.17, 0.006, -0.15));
  add_speaker(builder, X_WT * at(0.31, 0.29, 0));
  add_tablet(builder, X_WT * at(0.325, 0.145, 0, 0.1), 0.45);  // against the speaker
  add_magazine(builder, X_WT * at(-0.60, -0.22, 0, 0.1));
  add_phone(builder, X_WT * at(-0.60, -0.22, kMagazineHeight_m, 0.35));
}

void add_paper_things(SceneBuilder& builder, const Pose& X_WT) {
  const Pose X_WL = X_WT * at(-0.42, 0.225, 0);
  add_letter_tray(builder, X_WL);
  add_tissue_box(builder, X_WL * at(-0.01, 0.07, kLetterTrayHeight_m, 0.15));
  add_stapler(builder, X_WL * at(0, -0.08, kLetterTrayHeight_m, 0.4));
  add_notebook(builder, X_WT * at(-0.375, -0.25, 0, 0.06));
  add_ruler(builder, X_WT * at(-0.10, -0.32, 0, -0.06));
  add_calculator(builder, X_WT * at(0.27, -0.335, 0, kPi / 2 + 0.05));
}

void add_other_desk_things(SceneBuilder& builder, const Pose& X_WT, CounterRandom& random) {
  add_mug(builder, X_WT * at(0.46, -0.12, 0, -0.5), rgb(206, 44, 44));
  add_book_stack(builder, X_WT * at(0.68, 0.12, 0, 0.2), 4, random);
  add_tape_roll(builder, X_WT * at(0.66, 0.12, 0.155), rgb(240, 200, 60));
  add_pen_holder(builder, X_WT * at(0.485, 0.09, 0), rgb(44, 84, 160));
  add_desk_lamp(builder, X_WT * at(-0.62, 0.22, 0, -0.4), rgb(48, 140, 84));
  add_plant(builder, X_WT * at(-0.80, 0.02, 0), 0.32);
  add_bottle(builder, X_WT * at(0.47, 0.29, 0), rgb(40, 122, 150));
  add_spray_can(builder, X_WT * at(0.541, 0.29, 0), rgb(150, 60, 120));  // touches the bottle
  add_ball(builder, X_WT * at(-0.42, -0.02, 0), 0.055, rgb(238, 126, 34));
  add_carton(builder, X_WT * at(0.70, -0.22, 0, -0.3), {0.20, 0.15, 0.11});
  add_carton(builder, X_WT * at(0.70, -0.22, 0.11, 0.25), {0.12, 0.10, 0.08});
  // A book that leans against the carton.
  add_book(builder,
           X_WT * at(0.553, -0.27, 0.0875, -0.3) *
               Pose(Eigen::AngleAxisd(-1.15, Eigen::Vector3d::UnitY())),
           {0.19, 0.14, 0.022}, rgb(126, 60, 150));
}

void add_around_the_desk(SceneBuilder& builder, const Pose& X_WD) {
  const Pose X_WG = at(-0.15, 0.62, 0, kPi - 0.5);  // G: of the chair
  add_office_chair(builder, X_WG, rgb(36, 62, 120));
  builder.add_object(
      "jacket",
      X_WG * at(0, 0.254, 0.958) * Pose(Eigen::AngleAxisd(-0.15, Eigen::Vector3d::UnitX())),
      rounded_box(0.40, 0.13, 0.26, 0.05), plain(rgb(120, 128, 84)));
  add_computer(builder, X_WD * at(-0.66, 0.0, 0));
  add_footrest(builder, X_WD * at(0.06, -0.08, 0), kCarpet);
  add_power_strip(builder, at(-0.905, 1.48, 0));
  add_umbrella(builder, at(-1.06, 1.00, 0.02), {0.17, 0.05, 0.84}, rgb(150, 40, 66));
  add_bin(builder, at(-1.10, 1.45, 0), rgb(120, 126, 132));
  builder.add_object("poster tube",
                     at(-1.10, 1.45, 0.33) *
                         Pose(Eigen::AngleAxisd(-0.35, Eigen::Vector3d(0.3, 1, 0).normalized())),
                     cylinder(0.04, 0.60), plain(rgb(236, 232, 220)));
  add_carton(builder, at(-1.50, 1.42, 0, 0.15), {0.46, 0.36, 0.34});
  add_carton(builder, at(-1.48, 1.44, 0.34, -0.2), {0.34, 0.28, 0.24});
  add_globe(builder, at(-1.48, 1.44, 0.58));
}

void add_full_bookcase(SceneBuilder& builder, CounterRandom& random) {
  const Pose X_WG = office_bookcase();
  add_bookcase_frame(builder, X_WG, 0.95, 1.85);

  const Pose X_W0 = X_WG * on_board(0);
  add_storage_box(builder, X_W0 * at(-0.29, 0, 0), {0.28, 0.22, 0.16}, oak());
  add_storage_box(builder, X_W0 * at(-0.29, 0, 0.16, 0.1), {0.22, 0.18, 0.11}, oak());
  add_toolbox(builder, X_W0 * at(0.10, 0, 0), rgb(60, 110, 70));
  add_ball(builder, X_W0 * at(0.36, 0, 0), 0.075, rgb(60, 90, 180));

  const Pose X_W1 = X_WG * on_board(1);
  for (int i = 0; i < 4; ++i) {  // one beside the other, alike
    add_binder(builder, X_W1 * at(-0.40 + kBinderWidth_m * i, 0, 0), rgb(70, 84, 112));
  }
  add_binder(builder, X_W1 * at(-0.095, 0, 0), rgb(186, 66, 58), 0.0);
  add_binder(builder, X_W1 * at(0.025, 0, 0), rgb(222, 222, 214), 0.15);
  add_mug(builder, X_W1 * at(0.17, -0.03, 0), rgb(46, 92, 178));
  add_speaker(builder, X_W1 * at(0.33, 0.0, 0, 0.2));

  const Pose X_W2 = X_WG * on_board(2);
  add_book_row(builder, X_W2 * at(-0.20, 0, 0), 0.48, 0.26, random);
  add_table_clock(builder, X_W2 * at(0.18, 0.0, 0));
  add_bottle(builder, X_W2 * at(0.36, 0.0, 0), rgb(24, 62, 92));

  const Pose X_W3 = X_WG * on_board(3);
  add_book_stack(builder, X_W3 * at(-0.27, 0, 0), 3, random);
  add_teapot(builder, X_W3 * at(0.05, 0, 0, 0.3), rgb(226, 190, 60));
  add_globe(builder, X_W3 * at(0.31, 0, 0));

  const Pose X_W4 = X_WG * on_board(4);
  add_storage_box(builder, X_W4 * at(-0.29, 0, 0), {0.28, 0.23, 0.20}, plain(rgb(206, 160, 104)));
  add_storage_box(builder, X_W4 * at(-0.01, 0, 0), {0.28, 0.23, 0.20}, plain(rgb(206, 160, 104)));
  add_storage_box(builder, X_W4 * at(0.30, 0, 0, 0.2), {0.22, 0.20, 0.16},
                  plain(rgb(90, 130, 170)));
}

/// What the camera does not see on its way, but when it is turned.
void add_rest_of_furniture(SceneBuilder& builder) {
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

void add_back_wall_things(SceneBuilder& builder) {
  add_picture(builder, at(0.35, kHalfY_m, 1.72), 0.60, 0.44, rgb(236, 190, 70), rgb(40, 90, 150));
  add_clock(builder, at(0.40, kHalfY_m, 1.31));
  add_cork_board(builder, at(-0.42, kHalfY_m, 1.43), kWallColor);
  const Pose X_WS = at(0.83, kHalfY_m, 1.22);
  add_wall_board(builder, X_WS, 0.44, kWallColor);
  const Pose X_WB = X_WS * at(0, -kWallBoardDepth_m / 2, 0);
  for (int i = 0; i < 3; ++i) {  // touching each other
    add_jar(builder, X_WB * at(-0.16 + 2 * kJarRadius_m * i, 0, 0), 0.11 + 0.03 * i,
            rgb(226, 216, 190));
  }
  add_vase(builder, X_WB * at(0.13, 0, 0), rgb(70, 130, 140));
  constexpr double kSillTop_m = 1.01;
  add_tin(builder, at(-0.80, kHalfY_m, kSillTop_m), rgb(186, 60, 50));
  add_tin(builder, at(-0.89, kHalfY_m, kSillTop_m), rgb(60, 120, 80));
}

void add_other_walls_things(SceneBuilder& builder, CounterRandom& random) {
  add_wall_shelf(builder, at(kHalfX_m, 0.45, 1.55, -kPi / 2), 0.9, random);
  add_picture(builder, at(-kHalfX_m, 0.55, 1.45, kPi / 2), 0.7, 0.5, rgb(60, 130, 120),
              rgb(240, 220, 180));
  add_radiator(builder, at(-kHalfX_m, 1.05, 0, kPi / 2), 0.6);
  add_whiteboard(builder, at(-kHalfX_m, -0.6, 1.5, kPi / 2), 1.2);
}

}  // namespace

Pose office_desk_top() { return kDesk * at(0, 0, kDeskHeight_m); }

Pose office_bookcase() { return at(1.55, 1.64, 0); }

Color office_wall_color() { return kWallColor; }

Material office_carpet() { return kCarpet; }

void add_office(SceneBuilder& builder) {
  CounterRandom random(42);
  add_room(builder);
  const Pose& X_WD = kDesk;
  add_desk(builder, X_WD, 1.8, 0.78);
  const Pose X_WT = office_desk_top();
  add_computer_things(builder, X_WT);
  add_paper_things(builder, X_WT);
  add_other_desk_things(builder, X_WT, random);
  add_around_the_desk(builder, X_WD);
  add_full_bookcase(builder, random);
  add_rest_of_furniture(builder);
  add_back_wall_things(builder);
  add_other_walls_things(builder, random);
}

SceneWithPath office_scene(std::uint32_t seed) {
  SceneBuilder builder;
  add_office(builder);
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

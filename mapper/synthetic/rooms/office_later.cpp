// The office some time later: in another light, and on another way of the camera; and the same
// without a change of its things.
#include <numbers>
#include <utility>

#include "mapper/synthetic/rooms/desk_things.hpp"
#include "mapper/synthetic/rooms/furniture.hpp"
#include "mapper/synthetic/rooms/office.hpp"
#include "mapper/synthetic/rooms/room_shell.hpp"
#include "mapper/synthetic/rooms/scene_functions.hpp"
#include "mapper/synthetic/rooms/small_objects.hpp"
#include "mapper/synthetic/rooms/storage_things.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr double kPi = std::numbers::pi;

/// Lamps in the evening: a fifth less bright in the mean, and warmer.
const Color kEveningLight(0.90F, 0.80F, 0.66F);

/// Ten.
void take_things_away(SceneBuilder& builder) {
  for (const char* key :
       {"jacket grey 400x130x260", "phone black 190x200x96", "cork board white 420x25x300",
        "clock white 340x55x340", "toolbox green 350x190x238", "storage box tan 280x230x200 2",
        "poster tube white 80x80x600", "tissue box grey 210x110x125", "mug red 134x90x105",
        "tape roll yellow 130x130x40"}) {
    builder.take_away(key);
  }
}

/// Farther than their own size. The notebook has the desk's colour, the footrest the carpet's.
void carry_things(SceneBuilder& builder) {
  const Pose X_WT = office_desk_top();
  builder.move("bin grey 314x314x352", at(1.125, 1.27, 0));
  builder.move("footrest grey 420x298x163", at(-1.093, 1.42, 0, kPi / 2));
  builder.move("notebook tan 150x210x32", X_WT * at(0.06, 0.025, 0, kPi / 2));
  builder.move("globe blue 220x220x300 2", X_WT * at(-0.361, -0.20, 0));
  builder.move("table clock white 160x64x160", X_WT * at(0.255, 0.0, 0, -0.2));
}

/// Less far than their own size.
void shift_things(SceneBuilder& builder) {
  const Pose X_WT = office_desk_top();
  builder.move("office chair blue 621x593x1063", at(-0.20, 0.58, 0, kPi - 1.1));
  builder.move("keyboard black 440x150x24", X_WT * at(-0.052, -0.165, 0, -0.17));
  builder.move("monitor black 540x220x470", X_WT * at(-0.03, 0.215, 0, -0.2));
  builder.move("magazine yellow 240x300x20", X_WT * at(-0.60, -0.22, 0, 0.1 + kPi / 2));
  builder.move("carton tan 120x104x84", X_WT * at(0.69, -0.225, 0.11, 1.2));
}

/// Ten. The storage box has the desk's colour, the carpet-covered one the floor's, the panel the
/// wall's.
void bring_things(SceneBuilder& builder) {
  const Pose X_WT = office_desk_top();
  add_storage_box(builder, X_WT * at(-0.83, -0.22, 0), {0.13, 0.22, 0.13}, oak());
  add_storage_box(builder, at(0.07, 1.28, 0, 0.1), {0.40, 0.26, 0.14}, office_carpet());
  builder.add_object("panel", at(0.05, kOfficeBackWall_m - 0.02, 1.36), box(0.36, 0.04, 0.24),
                     plain(office_wall_color()));
  add_stool(builder, at(0.62, 0.78, 0), rgb(190, 60, 50));
  add_cooking_pot(builder, office_bookcase() * on_board(0) * at(0.10, 0, 0), rgb(196, 60, 50));
  add_speaker(builder, X_WT * at(0.455, -0.13, 0, 0.1));
  add_mug(builder, X_WT * at(-0.25, 0.03, 0, 0.4), rgb(232, 176, 48));
  add_tin(builder, at(-0.98, kOfficeBackWall_m, 1.01), rgb(46, 92, 178));
  add_bottle(builder, X_WT * at(-0.76, 0.33, 0), rgb(60, 110, 60));
  add_spray_can(builder, office_bookcase() * on_board(2) * at(0.285, 0, 0), rgb(230, 120, 40));
}

/// From the right to the left and back to the middle: "office" goes from the left to the right.
Trajectory later_path(std::uint32_t seed) {
  return Trajectory({{{1.00, -0.10, 1.50}, {0.95, 1.50, 0.88}},
                     {{0.65, 0.00, 1.46}, {0.75, 1.45, 0.85}},
                     {{0.25, -0.25, 1.42}, {0.30, 1.40, 0.82}},
                     {{-0.15, -0.30, 1.48}, {0.00, 1.40, 0.80}},
                     {{-0.60, -0.20, 1.44}, {-0.25, 1.40, 0.78}},
                     {{-0.98, -0.05, 1.40}, {-0.55, 1.40, 0.75}},
                     {{-1.12, 0.12, 1.46}, {-0.85, 1.40, 0.70}},
                     {{-0.75, 0.10, 1.50}, {-0.35, 1.40, 0.85}},
                     {{-0.25, 0.00, 1.42}, {0.10, 1.40, 0.92}}},
                    {.duration_s = 15, .seed = seed});
}

}  // namespace

SceneWithPath office_again_scene(std::uint32_t seed) {
  SceneBuilder builder;
  add_office(builder);
  return {std::move(builder).build(kEveningLight), later_path(seed)};
}

SceneWithPath office_later_scene(std::uint32_t seed) {
  SceneBuilder builder;
  add_office(builder);
  take_things_away(builder);
  carry_things(builder);
  shift_things(builder);
  bring_things(builder);
  return {std::move(builder).build(kEveningLight), later_path(seed)};
}

}  // namespace kintsugi::synthetic

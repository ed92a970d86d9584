#include "mapper/synthetic/rooms/room_shell.hpp"

#include <cmath>

#include "mapper/synthetic/rooms/small_objects.hpp"

namespace kintsugi::synthetic {

namespace {

const Material kFrame = plain(rgb(244, 242, 236));
const Material kSkirting = plain(rgb(232, 228, 218));
const Material kPane = textured(Texture::kPicture, rgb(170, 206, 236), rgb(236, 244, 250), 0.4);
const Material kDoor = textured(Texture::kWood, rgb(168, 116, 72), rgb(140, 92, 56), 0.14);
const Material kDark = plain(rgb(52, 54, 60));

constexpr double kTrim_m = 0.06;   // width of frames
constexpr double kProud_m = 0.02;  // by which frames and skirtings stand out of the wall

/// A box that is given by its extent along the wall and in height, centred in the wall.
void add_piece(SceneBuilder& builder, double left, double right, double bottom, double top,
               double thickness, const Material& material) {
  if (right - left < 1e-6 || top - bottom < 1e-6) return;
  builder.add(box(right - left, thickness, top - bottom),
              at((left + right) / 2, 0, (bottom + top) / 2), material);
}

void add_skirting(SceneBuilder& builder, double left, double right) {
  add_piece(builder, left, right, 0.0, 0.09, kWallThickness_m + 2 * kProud_m * 0.6, kSkirting);
}

/// Covers the edges of the hole: proud of the wall on both sides and of the hole's own faces.
void add_opening_frame(SceneBuilder& builder, const Opening& opening) {
  const double left = opening.middle_m - opening.width_m / 2;
  const double right = opening.middle_m + opening.width_m / 2;
  const double top = opening.top_m + kTrim_m;
  const double thickness = kWallThickness_m + 2 * kProud_m;
  add_piece(builder, left - kTrim_m, left + kProud_m, opening.bottom_m, top, thickness, kFrame);
  add_piece(builder, right - kProud_m, right + kTrim_m, opening.bottom_m, top, thickness, kFrame);
  add_piece(builder, left, right, opening.top_m - kProud_m, top, thickness, kFrame);
}

void add_window(SceneBuilder& builder, const Pose& X_WG, const Opening& opening) {
  builder.begin_structure("window", X_WG);
  add_opening_frame(builder, opening);
  const double left = opening.middle_m - opening.width_m / 2;
  const double right = opening.middle_m + opening.width_m / 2;
  add_piece(builder, left - kTrim_m, right + kTrim_m, opening.bottom_m - 0.04,
            opening.bottom_m + 0.01, kWallThickness_m + 6 * kProud_m, kFrame);
  add_piece(builder, left, right, opening.bottom_m, opening.top_m, 0.03, kPane);
  add_piece(builder, opening.middle_m - 0.025, opening.middle_m + 0.025, opening.bottom_m,
            opening.top_m, 0.07, kFrame);
}

void add_doorway(SceneBuilder& builder, const Pose& X_WG, const Opening& opening) {
  builder.begin_structure("door frame", X_WG);
  add_opening_frame(builder, opening);
  if (!opening.has_door_leaf) return;
  builder.begin_structure("door", X_WG);
  add_piece(builder, opening.middle_m - opening.width_m / 2, opening.middle_m + opening.width_m / 2,
            0.0, opening.top_m, 0.05, kDoor);
  for (double side : {-1.0, 1.0}) {
    builder.add(
        capsule(0.014, 0.13),
        at(opening.middle_m + opening.width_m / 2 - 0.13, side * 0.06, 1.02) * axis_along_x(),
        plain(rgb(180, 180, 176)));
  }
}

}  // namespace

void add_wall(SceneBuilder& builder, const Eigen::Vector3d& start_W, const Eigen::Vector3d& end_W,
              const Material& material, const std::vector<Opening>& openings, double height_m) {
  const Eigen::Vector3d along = end_W - start_W;
  const double length = along.norm();
  const Pose X_WG = at(start_W.x(), start_W.y(), start_W.z(), std::atan2(along.y(), along.x()));
  builder.begin_structure("wall", X_WG);
  double done = 0.0;
  for (const Opening& opening : openings) {
    const double left = opening.middle_m - opening.width_m / 2;
    const double right = opening.middle_m + opening.width_m / 2;
    add_piece(builder, done, left, 0, height_m, kWallThickness_m, material);
    add_piece(builder, left, right, 0, opening.bottom_m, kWallThickness_m, material);
    add_piece(builder, left, right, opening.top_m, height_m, kWallThickness_m, material);
    done = right;
  }
  add_piece(builder, done, length, 0, height_m, kWallThickness_m, material);

  done = 0.0;
  builder.begin_structure("skirting", X_WG);
  for (const Opening& opening : openings) {
    if (opening.bottom_m > 0.0) continue;
    add_skirting(builder, done, opening.middle_m - opening.width_m / 2 - kTrim_m);
    done = opening.middle_m + opening.width_m / 2 + kTrim_m;
  }
  add_skirting(builder, done, length);
  for (const Opening& opening : openings) {
    opening.bottom_m > 0.0 ? add_window(builder, X_WG, opening)
                           : add_doorway(builder, X_WG, opening);
  }
}

void add_slab(SceneBuilder& builder, const char* name, const Eigen::Vector2d& min_W,
              const Eigen::Vector2d& max_W, double top_z, const Material& material) {
  constexpr double kThickness_m = 0.2;
  const Eigen::Vector2d middle = (min_W + max_W) / 2;
  builder.add_structure(name, at(middle.x(), middle.y(), top_z - kThickness_m / 2),
                        box(max_W.x() - min_W.x(), max_W.y() - min_W.y(), kThickness_m), material);
}

void add_picture(SceneBuilder& builder, const Pose& X_WG, double width, double height,
                 const Color& color, const Color& second_color) {
  builder.begin_object("picture", X_WG);
  builder.add(box(width, 0.03, height), at(0, -0.015, 0), kDark);
  builder.add(box(width - 0.06, 0.01, height - 0.06), at(0, -0.028, 0),
              textured(Texture::kPicture, color, second_color, 0.25 * width));
}

void add_whiteboard(SceneBuilder& builder, const Pose& X_WG, double width) {
  builder.begin_object("whiteboard", X_WG);
  builder.add(box(width, 0.03, 0.80), at(0, -0.015, 0), plain(rgb(150, 154, 160)));
  builder.add(box(width - 0.06, 0.01, 0.74), at(0, -0.029, 0),
              textured(Texture::kScreen, rgb(248, 248, 248), rgb(40, 70, 160), 0.01));
  builder.add(box(0.6 * width, 0.07, 0.025), at(0, -0.05, -0.40), plain(rgb(150, 154, 160)));
}

void add_clock(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("clock", X_WG);
  builder.add(cylinder(0.15, 0.04), at(0, -0.02, 0) * axis_along_y(), plain(rgb(246, 246, 242)));
  builder.add(torus(0.15, 0.02), at(0, -0.035, 0) * axis_along_y(), plain(rgb(190, 44, 40)));
  builder.add(box(0.016, 0.012, 0.11), at(0, -0.044, 0.05), kDark);
  builder.add(box(0.08, 0.012, 0.016), at(0.035, -0.044, 0), kDark);
}

void add_radiator(SceneBuilder& builder, const Pose& X_WG, double width) {
  builder.begin_object("radiator", X_WG);
  builder.add(box(width, 0.04, 0.50), at(0, -0.05, 0.40), plain(rgb(238, 238, 234)));
  const int ribs = static_cast<int>(width / 0.09);
  for (int i = 0; i < ribs; ++i) {
    const double x = (i + 0.5) * width / ribs - width / 2;
    builder.add(capsule(0.024, 0.54), at(x, -0.08, 0.40), plain(rgb(238, 238, 234)));
  }
}

void add_wall_shelf(SceneBuilder& builder, const Pose& X_WG, double width, CounterRandom& random) {
  builder.begin_object("wall shelf", X_WG);
  builder.add(box(width, 0.24, 0.03), at(0, -0.12, -0.015),
              textured(Texture::kWood, rgb(206, 160, 104), rgb(178, 130, 80), 0.10));
  for (double side : {-1.0, 1.0}) {
    builder.add(box(0.03, 0.18, 0.12), at(side * (width / 2 - 0.12), -0.09, -0.09), kDark);
  }
  add_book_row(builder, X_WG * at(-0.22 * width, -0.13, 0), 0.5 * width, 0.24, random);
  add_any_small_object(builder, X_WG * at(0.30 * width, -0.13, 0), random);
}

void add_fire_extinguisher(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("fire extinguisher", X_WG);
  builder.add(capsule(0.075, 0.48), at(0, -0.09, 0.95), plain(rgb(204, 32, 30)));
  builder.add(cylinder(0.022, 0.07), at(0, -0.09, 1.20), kDark);
  builder.add(capsule(0.016, 0.34), at(0.085, -0.10, 1.05), kDark);
}

void add_wall_lamp(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("wall lamp", X_WG);
  builder.add(sphere(0.10), at(0, -0.14, 0), plain(rgb(252, 240, 200)));
  builder.add(cylinder(0.06, 0.04), at(0, -0.02, 0) * axis_along_y(), plain(rgb(180, 150, 80)));
}

void add_coat_hooks(SceneBuilder& builder, const Pose& X_WG, CounterRandom& random) {
  builder.begin_object("coat hooks", X_WG);
  builder.add(box(0.90, 0.03, 0.10), at(0, -0.015, 0), kDoor);
  for (double x : {-0.3, 0.0, 0.3}) {
    builder.add(sphere(0.025), at(x, -0.05, 0), plain(rgb(180, 180, 176)));
  }
  for (double x : {-0.3, 0.3}) {
    builder.add_object("jacket", X_WG * at(x, -0.12, -0.38), rounded_box(0.34, 0.15, 0.66, 0.06),
                       plain(any_color(random)));
  }
}

}  // namespace kintsugi::synthetic

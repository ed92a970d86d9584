#include "mapper/synthetic/rooms/furniture.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "mapper/synthetic/rooms/small_objects.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr double kPi = std::numbers::pi;

// Of bookcases.
constexpr double kBoard_m = 0.025;
constexpr double kLowestBoard_m = 0.05;
constexpr double kBoardSpacing_m = 0.36;

const Material kOak = textured(Texture::kWood, rgb(206, 160, 104), rgb(178, 130, 80), 0.10);
const Material kWalnut = textured(Texture::kWood, rgb(128, 84, 54), rgb(98, 62, 40), 0.10);
const Material kDark = plain(rgb(52, 54, 60));
const Material kMetal = plain(rgb(160, 164, 170));

void add_four_legs(SceneBuilder& builder, double width, double depth, double height,
                   double thickness, const Material& material) {
  for (double x : {-1.0, 1.0}) {
    for (double y : {-1.0, 1.0}) {
      builder.add(box(thickness, thickness, height),
                  at(x * (width - thickness) / 2, y * (depth - thickness) / 2, height / 2),
                  material);
    }
  }
}

/// Doors or drawers: panels that stand 1.5 cm proud of a front at y, each with a knob.
void add_fronts(SceneBuilder& builder, double width, double bottom, double top, double y, int count,
                const Material& material) {
  const double each = width / count;
  for (int i = 0; i < count; ++i) {
    const double x = -width / 2 + (i + 0.5) * each;
    builder.add(box(each - 0.03, 0.03, top - bottom), at(x, y, (bottom + top) / 2), material);
    const double towards_middle = i % 2 == 0 ? 1.0 : -1.0;
    builder.add(sphere(0.02),
                at(x + towards_middle * (each / 2 - 0.06), y - 0.025, (bottom + top) / 2), kMetal);
  }
}

}  // namespace

Material oak() { return kOak; }

void add_desk(SceneBuilder& builder, const Pose& X_WG, double width, double depth) {
  builder.begin_object("desk", X_WG);
  builder.add(box(width, depth, 0.035), at(0, 0, kDeskHeight_m - 0.0175), kOak);
  const double under = kDeskHeight_m - 0.035;
  builder.add(box(0.04, depth - 0.06, under), at(-width / 2 + 0.04, 0, under / 2), kDark);
  builder.add(box(width - 0.1, 0.03, 0.35), at(0, depth / 2 - 0.06, under - 0.175), kDark);
  builder.begin_object("drawers", X_WG);
  builder.add(box(0.42, depth - 0.10, 0.60), at(width / 2 - 0.25, 0.02, 0.33),
              plain(rgb(214, 214, 208)));
  for (int i = 0; i < 3; ++i) {
    const double z = 0.13 + 0.2 * i;
    builder.add(box(0.38, 0.03, 0.17), at(width / 2 - 0.25, -depth / 2 + 0.07, z),
                plain(rgb(190, 192, 190)));
    builder.add(capsule(0.012, 0.16),
                at(width / 2 - 0.25, -depth / 2 + 0.045, z + 0.04) * axis_along_x(), kDark);
  }
}

void add_table(SceneBuilder& builder, const Pose& X_WG, double width, double depth) {
  builder.begin_object("table", X_WG);
  builder.add(rounded_box(width, depth, 0.04, 0.015), at(0, 0, kTableHeight_m - 0.02), kWalnut);
  add_four_legs(builder, width - 0.08, depth - 0.08, kTableHeight_m - 0.04, 0.06, kWalnut);
}

void add_round_table(SceneBuilder& builder, const Pose& X_WG, double radius, double height) {
  builder.begin_object("round table", X_WG);
  builder.add(cylinder(radius, 0.035), at(0, 0, height - 0.0175), kOak);
  builder.add(cylinder(0.04, height - 0.06), at(0, 0, height / 2 - 0.005), kMetal);
  builder.add(cone(0.6 * radius, 0.06, 0.04), at(0, 0, 0.02), kMetal);
}

void add_office_chair(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("office chair", X_WG);
  builder.add(rounded_box(0.48, 0.46, 0.09, 0.04), at(0, 0, 0.47), plain(color));
  builder.add(rounded_box(0.44, 0.08, 0.52, 0.035),
              at(0, 0.23, 0.80) * Pose(Eigen::AngleAxisd(-0.15, Eigen::Vector3d::UnitX())),
              plain(color));
  builder.add(box(0.06, 0.03, 0.24), at(0, 0.225, 0.52), kDark);
  builder.add(cylinder(0.03, 0.34), at(0, 0, 0.26), kMetal);
  for (int i = 0; i < 5; ++i) {
    const Pose X_GS = at(0, 0, 0.09, 2 * kPi * i / 5 + 0.3);
    builder.add(capsule(0.025, 0.32), X_GS * at(0.15, 0, 0) * axis_along_x(), kDark);
    builder.add(sphere(0.035), X_GS * at(0.28, 0, -0.055), kDark);
  }
  for (double side : {-1.0, 1.0}) {
    builder.add(capsule(0.022, 0.26), at(side * 0.27, 0.02, 0.66) * axis_along_y(), kDark);
    builder.add(capsule(0.016, 0.24), at(side * 0.26, 0.04, 0.55), kDark);
  }
}

void add_chair(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("chair", X_WG);
  builder.add(rounded_box(0.42, 0.42, 0.05, 0.02), at(0, 0, 0.45), plain(color));
  add_four_legs(builder, 0.40, 0.40, 0.43, 0.04, kWalnut);
  for (double side : {-1.0, 1.0}) {
    builder.add(box(0.035, 0.035, 0.46), at(side * 0.18, 0.19, 0.68), kWalnut);
  }
  builder.add(rounded_box(0.40, 0.035, 0.20, 0.015), at(0, 0.185, 0.82), plain(color));
}

void add_stool(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("stool", X_WG);
  builder.add(cylinder(0.17, 0.05), at(0, 0, 0.475), plain(color));
  builder.add(cylinder(0.03, 0.44), at(0, 0, 0.23), kMetal);
  builder.add(torus(0.16, 0.02), at(0, 0, 0.02), kMetal);
  builder.add(box(0.30, 0.035, 0.02), at(0, 0, 0.02), kMetal);
}

void add_sofa(SceneBuilder& builder, const Pose& X_WG, double width, const Color& color) {
  builder.begin_object("sofa", X_WG);
  const Material cloth = textured(Texture::kCarpet, color, 0.85F * color, 0.012);
  builder.add(rounded_box(width, 0.80, 0.28, 0.06), at(0, 0, 0.18), cloth);
  builder.add(rounded_box(width, 0.24, 0.55, 0.08), at(0, 0.30, 0.55), cloth);
  for (double side : {-1.0, 1.0}) {
    builder.add(rounded_box(0.20, 0.80, 0.52, 0.08), at(side * (width - 0.20) / 2, 0, 0.30), cloth);
  }
  for (double side : {-1.0, 1.0}) {
    builder.add_object("cushion", X_WG * at(side * (width / 2 - 0.42), 0.10, 0.47, side * 0.3),
                       rounded_box(0.36, 0.14, 0.34, 0.06),
                       textured(Texture::kChecks, rgb(236, 206, 90), rgb(214, 120, 60), 0.06));
  }
}

void add_bed(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("bed", X_WG);
  builder.add(box(1.0, 2.0, 0.30), at(0, 0, 0.15), kWalnut);
  builder.add(box(1.0, 0.06, 0.85), at(0, 1.0, 0.425), kWalnut);
  builder.add_object("blanket", X_WG * at(0, -0.25, 0.38), rounded_box(0.98, 1.45, 0.20, 0.07),
                     textured(Texture::kChecks, color, rgb(238, 236, 228), 0.12));
  builder.add_object("pillow", X_WG * at(0, 0.72, 0.38), rounded_box(0.66, 0.40, 0.16, 0.07),
                     plain(rgb(240, 240, 244)));
}

void add_cabinet(SceneBuilder& builder, const Pose& X_WG, double width, const Color& color) {
  builder.begin_object("cabinet", X_WG);
  builder.add(box(width, 0.42, kCabinetHeight_m), at(0, 0, kCabinetHeight_m / 2), plain(color));
  add_fronts(builder, width, 0.08, kCabinetHeight_m - 0.05, -0.21, width > 0.7 ? 2 : 1,
             plain(0.88F * color));
}

void add_counter(SceneBuilder& builder, const Pose& X_WG, double width) {
  builder.begin_object("counter", X_WG);
  builder.add(box(width, 0.58, 0.86), at(0, 0.01, 0.43), plain(rgb(226, 228, 222)));
  add_fronts(builder, width, 0.12, 0.80, -0.28, std::max(2, static_cast<int>(width / 0.5)),
             plain(rgb(120, 158, 152)));
  builder.begin_object("worktop", X_WG);
  builder.add(box(width + 0.02, 0.64, 0.04), at(0, 0, kCounterHeight_m - 0.02),
              textured(Texture::kCarpet, rgb(86, 84, 84), rgb(120, 116, 112), 0.01));
}

void add_fridge(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("fridge", X_WG);
  builder.add(rounded_box(0.60, 0.60, 1.75, 0.03), at(0, 0, 0.875), plain(rgb(214, 220, 224)));
  builder.add(rounded_box(0.57, 0.05, 1.12, 0.02), at(0, -0.30, 0.62), plain(rgb(228, 232, 236)));
  builder.add(rounded_box(0.57, 0.05, 0.48, 0.02), at(0, -0.30, 1.45), plain(rgb(228, 232, 236)));
  for (double z : {0.95, 1.32}) {
    builder.add(capsule(0.016, 0.22), at(0.23, -0.345, z), kDark);
  }
}

void add_bench(SceneBuilder& builder, const Pose& X_WG, double width) {
  builder.begin_object("bench", X_WG);
  for (double y : {-0.13, 0.0, 0.13}) {
    builder.add(rounded_box(width, 0.11, 0.04, 0.012), at(0, y, 0.44), kOak);
  }
  for (double side : {-1.0, 1.0}) {
    builder.add(box(0.06, 0.36, 0.42), at(side * (width / 2 - 0.15), 0, 0.21), kDark);
  }
}

void add_bin(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("bin", X_WG);
  builder.add(cylinder(0.15, 0.34, 0.135), at(0, 0, 0.17), plain(color));
  builder.add(cylinder(0.14, 0.06), at(0, 0, 0.031), plain(0.6F * color));
  builder.add(torus(0.145, 0.012), at(0, 0, 0.34), plain(0.8F * color));
}

void add_floor_lamp(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("floor lamp", X_WG);
  builder.add(cone(0.22, 0.13, 0.28), at(0, 0, 1.52), plain(color));
  builder.add(cylinder(0.018, 1.40), at(0, 0, 0.72), kMetal);
  builder.add(cylinder(0.15, 0.03), at(0, 0, 0.015), kDark);
}

void add_coat_rack(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("coat rack", X_WG);
  builder.add(cylinder(0.025, 1.70), at(0, 0, 0.86), kWalnut);
  builder.add(cone(0.20, 0.04, 0.05), at(0, 0, 0.025), kWalnut);
  builder.add(torus(0.12, 0.015), at(0, 0, 1.60), kWalnut);
  builder.begin_object("coat", X_WG);
  builder.add(rounded_box(0.34, 0.16, 0.80, 0.07), at(0, -0.14, 1.15), plain(rgb(46, 70, 110)));
  for (double side : {-1.0, 1.0}) {
    builder.add(capsule(0.055, 0.62), at(side * 0.20, -0.14, 1.22), plain(rgb(46, 70, 110)));
  }
}

void add_backpack(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("backpack", X_WG);
  builder.add(rounded_box(0.30, 0.18, 0.42, 0.07), at(0, 0, 0.21), plain(color));
  builder.add(rounded_box(0.22, 0.08, 0.18, 0.035), at(0, -0.11, 0.14), plain(0.75F * color));
  builder.add(torus(0.04, 0.012), at(0, 0.02, 0.43) * axis_along_y(), kDark);
}

void add_traffic_cone(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("traffic cone", X_WG);
  builder.add(cone(0.13, 0.025, 0.46), at(0, 0, 0.26),
              textured(Texture::kBands, rgb(238, 104, 30), rgb(242, 242, 240), 0.1));
  builder.add(box(0.32, 0.32, 0.03), at(0, 0, 0.015), plain(rgb(238, 104, 30)));
}

int add_bookcase_frame(SceneBuilder& builder, const Pose& X_WG, double width, double height) {
  constexpr double kDepth_m = 0.28;
  builder.begin_object("bookcase", X_WG);
  for (double side : {-1.0, 1.0}) {
    builder.add(box(kBoard_m, kDepth_m, height), at(side * (width - kBoard_m) / 2, 0, height / 2),
                kOak);
  }
  builder.add(box(width, 0.02, height), at(0, kDepth_m / 2 - 0.01, height / 2), kOak);
  const int boards = static_cast<int>((height - kBoard_m) / kBoardSpacing_m) + 1;
  for (int i = 0; i < boards; ++i) {
    builder.add(box(width, kDepth_m, kBoard_m), at(0, 0, kLowestBoard_m + kBoardSpacing_m * i),
                kOak);
  }
  return boards;
}

Pose on_board(int i) { return at(0, -0.02, kLowestBoard_m + kBoardSpacing_m * i + kBoard_m / 2); }

void add_bookcase(SceneBuilder& builder, const Pose& X_WG, double width, double height,
                  CounterRandom& random) {
  const int boards = add_bookcase_frame(builder, X_WG, width, height);
  for (int i = 0; i < boards; ++i) {
    const Pose X_WB = X_WG * on_board(i);
    const double room = width - 2 * kBoard_m - 0.02;
    const bool is_top = kLowestBoard_m + kBoardSpacing_m * (i + 1) > height;
    if (i % 2 == 0 && !is_top) {
      add_book_row(builder, X_WB * at(-0.18 * room, 0, 0), 0.6 * room, 0.26, random);
      add_any_small_object(builder, X_WB * at(0.32 * room, 0, 0), random);
    } else {
      add_any_small_object(builder, X_WB * at(-0.28 * room, 0, 0), random);
      if (room > 0.7) add_any_small_object(builder, X_WB * at(0.28 * room, 0, 0), random);
    }
  }
}

}  // namespace kintsugi::synthetic

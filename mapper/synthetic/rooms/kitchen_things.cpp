#include "mapper/synthetic/rooms/kitchen_things.hpp"

#include <algorithm>
#include <numbers>

#include "mapper/synthetic/rooms/furniture.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr double kBodyDepth_m = 0.58;
constexpr double kWorktop_m = 0.04;  // thickness
constexpr double kBodyHeight_m = kCounterHeight_m - kWorktop_m;

const Material kBody = plain(rgb(226, 228, 222));
const Material kDoor = textured(Texture::kWood, rgb(150, 172, 160), rgb(132, 156, 144), 0.12);
const Material kWorktop = textured(Texture::kCarpet, rgb(86, 84, 84), rgb(120, 116, 112), 0.01);
const Material kSteel = plain(rgb(172, 176, 180));
const Material kDark = plain(rgb(44, 46, 50));

/// Doors 1.5 cm proud of a front at y, each with a bar as its handle at the height `handle_z`.
void add_doors(SceneBuilder& builder, double width, double bottom, double top, double y,
               double handle_z) {
  const int count = std::max(1, static_cast<int>(width / 0.4));
  const double each = width / count;
  for (int i = 0; i < count; ++i) {
    const double x = (i + 0.5) * each - width / 2;
    builder.add(box(each - 0.02, 0.03, top - bottom), at(x, y, (bottom + top) / 2), kDoor);
    builder.add(capsule(0.009, 0.6 * each), at(x, y - 0.04, handle_z) * axis_along_x(), kSteel);
  }
}

}  // namespace

void add_sink_counter(SceneBuilder& builder, const Pose& X_WG, double width) {
  constexpr double kHoleX_m = 0.50;
  constexpr double kHoleY_m = 0.38;
  constexpr double kBasin_m = 0.18;  // depth
  constexpr double kSheet_m = 0.01;
  const double basin_bottom = kCounterHeight_m - kBasin_m;
  builder.begin_object("counter", X_WG);
  builder.add(box(width, kBodyDepth_m, basin_bottom - 0.01), at(0, 0.01, (basin_bottom - 0.01) / 2),
              kBody);
  builder.add(box(width, 0.03, kBodyHeight_m), at(0, -kBodyDepth_m / 2 + 0.025, kBodyHeight_m / 2),
              kBody);
  add_doors(builder, width, 0.12, 0.80, -0.28, 0.74);

  builder.begin_object("worktop", X_WG);
  const double z = kCounterHeight_m - kWorktop_m / 2;
  const double side = (width + 0.02 - kHoleX_m) / 2;
  const double strip = (0.64 - kHoleY_m) / 2;
  for (const double sign : {-1.0, 1.0}) {
    builder.add(box(side, 0.64, kWorktop_m), at(sign * (kHoleX_m + side) / 2, 0, z), kWorktop);
    builder.add(box(kHoleX_m, strip, kWorktop_m), at(0, sign * (kHoleY_m + strip) / 2, z),
                kWorktop);
  }

  builder.begin_object("sink", X_WG * at(0, 0, basin_bottom));
  builder.add(box(kHoleX_m, kHoleY_m, kSheet_m), at(0, 0, kSheet_m / 2), kSteel);
  for (const double sign : {-1.0, 1.0}) {
    builder.add(box(kSheet_m, kHoleY_m, kBasin_m),
                at(sign * (kHoleX_m - kSheet_m) / 2, 0, kBasin_m / 2 + 0.003), kSteel);
    builder.add(box(kHoleX_m, kSheet_m, kBasin_m),
                at(0, sign * (kHoleY_m - kSheet_m) / 2, kBasin_m / 2 + 0.003), kSteel);
  }
  builder.add(cylinder(0.03, 0.02), at(0, 0, 0.012), kDark);

  builder.begin_object("tap", X_WG * at(0, 0.25, kCounterHeight_m));
  builder.add(capsule(0.018, 0.34), at(0, 0, 0.15), kSteel);
  builder.add(capsule(0.014, 0.22), at(0, -0.10, 0.31) * axis_along_y(), kSteel);
  builder.add(capsule(0.013, 0.08), at(0, -0.20, 0.285), kSteel);
  builder.add(cylinder(0.035, 0.02), at(0, 0, 0.01), kSteel);
}

void add_stove(SceneBuilder& builder, const Pose& X_WG) {
  constexpr double kWidth_m = 0.60;
  builder.begin_object("stove", X_WG);
  builder.add(box(kWidth_m, kBodyDepth_m, kBodyHeight_m), at(0, 0.01, kBodyHeight_m / 2),
              plain(rgb(210, 212, 214)));
  builder.add(box(kWidth_m, 0.64, kWorktop_m), at(0, 0, kCounterHeight_m - kWorktop_m / 2), kDark);
  builder.add(box(0.54, 0.03, 0.46), at(0, -0.285, 0.42), kDark);
  builder.add(box(0.40, 0.01, 0.28), at(0, -0.30, 0.40), plain(rgb(86, 92, 100)));
  builder.add(capsule(0.014, 0.48), at(0, -0.335, 0.68) * axis_along_x(), kSteel);
  for (int i = 0; i < 5; ++i) {
    builder.add(cylinder(0.022, 0.03), at(0.1 * (i - 2), -0.295, 0.79) * axis_along_y(), kSteel);
  }
  for (const double x : {-0.14, 0.14}) {
    for (const double y : {-0.13, 0.14}) {
      builder.add(cylinder(x * y > 0 ? 0.10 : 0.08, 0.012), at(x, y, kCounterHeight_m + 0.005),
                  plain(rgb(96, 92, 90)));
    }
  }
}

void add_wall_cupboard(SceneBuilder& builder, const Pose& X_WG, double width) {
  constexpr double kDepth_m = 0.32;
  constexpr double kHeight_m = 0.66;
  builder.begin_object("wall cupboard", X_WG);
  builder.add(box(width, kDepth_m, kHeight_m), at(0, -kDepth_m / 2, kHeight_m / 2), kBody);
  add_doors(builder, width, 0.01, kHeight_m - 0.01, -kDepth_m, 0.08);
}

void add_extractor_hood(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("extractor hood", X_WG);
  builder.add(box(0.60, 0.46, 0.07), at(0, -0.23, 0.035), kSteel);
  builder.add(box(0.40, 0.34, 0.12), at(0, -0.17, 0.13), kSteel);
  builder.add(box(0.24, 0.24, 0.60), at(0, -0.12, 0.49), kSteel);
}

void add_toaster(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("toaster", X_WG);
  builder.add(rounded_box(0.28, 0.16, 0.18, 0.03), at(0, 0, 0.10), plain(rgb(196, 70, 56)));
  for (const double y : {-0.03, 0.03}) {
    builder.add(box(0.18, 0.02, 0.012), at(0, y, 0.19), kDark);
  }
  builder.add(box(0.02, 0.03, 0.02), at(0.15, 0, 0.13), kDark);
}

void add_plate(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("plate", X_WG);
  builder.add(cone(0.075, 0.125, 0.022), at(0, 0, 0.011), plain(color));
  builder.add(torus(0.118, 0.008), at(0, 0, 0.021), plain(0.8F * color));
}

void add_chopping_board(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("chopping board", X_WG);
  builder.add(rounded_box(0.36, 0.24, 0.025, 0.008), at(0, 0, 0.0125),
              textured(Texture::kWood, rgb(212, 172, 118), rgb(184, 140, 90), 0.04));
  builder.add_object("bread", X_WG * at(-0.03, 0.02, 0.075), rounded_box(0.24, 0.12, 0.10, 0.045),
                     textured(Texture::kPlaster, rgb(190, 128, 66), rgb(0, 0, 0), 0.02));
}

void add_paper_roll(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("paper roll", X_WG);
  builder.add(cylinder(0.06, 0.23), at(0, 0, 0.135), plain(rgb(246, 246, 244)));
  builder.add(cylinder(0.008, 0.30), at(0, 0, 0.15), kSteel);
  builder.add(cylinder(0.075, 0.02), at(0, 0, 0.01), kSteel);
}

void add_dish_rack(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("dish rack", X_WG);
  builder.add(box(0.40, 0.28, 0.02), at(0, 0, 0.01), kDark);
  for (const double y : {-0.13, 0.13}) {
    builder.add(capsule(0.006, 0.40), at(0, y, 0.09) * axis_along_x(), kSteel);
    for (const double x : {-0.19, 0.19}) builder.add(capsule(0.006, 0.09), at(x, y, 0.05), kSteel);
  }
  for (int i = 0; i < 4; ++i) {
    const Pose X_GP =
        at(-0.12 + 0.075 * i, 0, 0.135) * Pose(Eigen::AngleAxisd(1.35, Eigen::Vector3d::UnitY()));
    builder.add_object("plate", X_WG * X_GP, cylinder(0.11, 0.014),
                       plain(i % 2 == 0 ? rgb(240, 238, 230) : rgb(120, 160, 190)));
  }
}

}  // namespace kintsugi::synthetic

#include "mapper/synthetic/rooms/small_objects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kintsugi::synthetic {

namespace {

constexpr double kPi = std::numbers::pi;

const Material kDark = plain(rgb(45, 47, 52));
const Material kMetal = plain(rgb(150, 155, 160));

Pose tilted(const Pose& X, const Eigen::Vector3d& axis, double angle_rad) {
  return X * Pose(Eigen::AngleAxisd(angle_rad, axis));
}

/// The solid's axis lies along `axis_angle_rad` in the plane of x and z, its middle at p.
Pose leaning(const Eigen::Vector3d& p, double axis_angle_rad) {
  return tilted(at(p.x(), p.y(), p.z()), Eigen::Vector3d::UnitY(), axis_angle_rad);
}

}  // namespace

Color any_color(CounterRandom& random) {
  static const std::array<Color, 12> kPalette = {
      rgb(196, 52, 48),  rgb(46, 92, 178),  rgb(58, 146, 76),   rgb(232, 176, 48),
      rgb(122, 66, 150), rgb(230, 120, 40), rgb(40, 150, 160),  rgb(214, 96, 140),
      rgb(120, 82, 52),  rgb(90, 96, 104),  rgb(236, 226, 204), rgb(24, 62, 92)};
  return kPalette[random.integer(0, static_cast<int>(kPalette.size()) - 1)];
}

void add_monitor(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("monitor", X_WG);
  builder.add(rounded_box(0.54, 0.045, 0.34, 0.012), at(0, 0, 0.30), kDark);
  builder.add(box(0.50, 0.004, 0.30), at(0, -0.0235, 0.30),
              textured(Texture::kScreen, rgb(40, 78, 128), rgb(214, 228, 240), 0.01));
  builder.add(box(0.06, 0.03, 0.16), at(0, 0.03, 0.09), kDark);
  builder.add(cylinder(0.11, 0.02), at(0, 0.01, 0.01), kDark);
}

void add_laptop(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("laptop", X_WG);
  builder.add(rounded_box(0.34, 0.24, 0.022, 0.008), at(0, 0, 0.011), kMetal);
  builder.add(box(0.29, 0.11, 0.004), at(0, 0.03, 0.023),
              textured(Texture::kKeys, rgb(120, 124, 128), rgb(50, 52, 56), 0.019));
  const Pose X_GL = tilted(at(0, 0.12, 0.02), Eigen::Vector3d::UnitX(), -0.3);
  builder.add(rounded_box(0.34, 0.018, 0.23, 0.006), X_GL * at(0, 0, 0.115), kMetal);
  builder.add(box(0.31, 0.004, 0.20), X_GL * at(0, -0.009, 0.115),
              textured(Texture::kScreen, rgb(236, 238, 240), rgb(60, 64, 72), 0.01));
}

void add_keyboard(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("keyboard", X_WG);
  builder.add(rounded_box(0.44, 0.15, 0.024, 0.008), at(0, 0, 0.012),
              textured(Texture::kKeys, rgb(58, 60, 66), rgb(206, 208, 210), 0.021));
}

void add_mouse(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("mouse", X_WG);
  builder.add(rounded_box(0.065, 0.11, 0.038, 0.018), at(0, 0, 0.019), plain(rgb(210, 212, 216)));
}

void add_phone(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("phone", X_WG);
  builder.add(rounded_box(0.19, 0.20, 0.05, 0.012), at(0, 0, 0.025),
              textured(Texture::kKeys, rgb(70, 72, 80), rgb(190, 190, 186), 0.03));
  builder.add(capsule(0.024, 0.20), at(-0.06, 0, 0.072) * axis_along_y(), kDark);
}

void add_speaker(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("speaker", X_WG);
  builder.add(rounded_box(0.11, 0.13, 0.20, 0.012), at(0, 0, 0.10),
              textured(Texture::kWood, rgb(96, 62, 40), rgb(70, 44, 28), 0.05));
  builder.add(torus(0.032, 0.010), at(0, -0.064, 0.07) * axis_along_y(), kDark);
  builder.add(sphere(0.022), at(0, -0.058, 0.15), kMetal);
}

void add_desk_lamp(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("desk lamp", X_WG);
  builder.add(cylinder(0.085, 0.024), at(0, 0, 0.012), plain(color));
  builder.add(capsule(0.013, 0.28), leaning({-0.05, 0, 0.145}, -0.42), kMetal);
  builder.add(capsule(0.013, 0.26), leaning({-0.01, 0, 0.35}, 0.75), kMetal);
  builder.add(cone(0.085, 0.035, 0.11), leaning({0.115, 0, 0.42}, 0.35), plain(color));
}

void add_mug(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("mug", X_WG);
  builder.add(cylinder(0.045, 0.105, 0.034), at(0, 0, 0.0525), plain(color));
  builder.add(cylinder(0.036, 0.03), at(0, 0, 0.016), plain(rgb(70, 42, 26)));
  builder.add(torus(0.030, 0.009), at(0.050, 0, 0.055) * axis_along_y(), plain(color));
}

void add_bowl(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("bowl", X_WG);
  builder.add(cone(0.06, 0.12, 0.06), at(0, 0, 0.03), plain(color));
  builder.add(torus(0.115, 0.012), at(0, 0, 0.062), plain(color));
  builder.add_object("apple", X_WG * at(0.045, 0.02, 0.092), sphere(0.040),
                     plain(rgb(190, 40, 40)));
  builder.add_object("orange", X_WG * at(-0.045, 0.03, 0.095), sphere(0.043),
                     plain(rgb(236, 140, 30)));
  builder.add_object("lime", X_WG * at(0, -0.055, 0.088), sphere(0.036), plain(rgb(120, 180, 50)));
}

void add_bottle(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("bottle", X_WG);
  builder.add(cylinder(0.038, 0.18), at(0, 0, 0.09),
              textured(Texture::kBands, color, rgb(240, 240, 232), 0.1));
  builder.add(cone(0.038, 0.015, 0.05), at(0, 0, 0.205), plain(color));
  builder.add(cylinder(0.016, 0.04), at(0, 0, 0.25), plain(rgb(226, 226, 220)));
}

void add_teapot(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("teapot", X_WG);
  builder.add(sphere(0.085), at(0, 0, 0.08), plain(color));
  builder.add(cylinder(0.05, 0.02), at(0, 0, 0.01), plain(color));
  builder.add(sphere(0.016), at(0, 0, 0.178), kDark);
  builder.add(cone(0.026, 0.013, 0.10), leaning({-0.10, 0, 0.10}, -0.8), plain(color));
  builder.add(torus(0.045, 0.010), at(0.09, 0, 0.09) * axis_along_y(), kDark);
}

void add_cooking_pot(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("cooking pot", X_WG);
  builder.add(cylinder(0.115, 0.13, 0.100), at(0, 0, 0.065), plain(color));
  builder.add(cylinder(0.105, 0.03), at(0, 0, 0.016), kMetal);
  for (double side : {-1.0, 1.0}) {
    builder.add(torus(0.028, 0.009), at(side * 0.125, 0, 0.10), kDark);
  }
}

void add_pen_holder(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("pen holder", X_WG);
  builder.add(cylinder(0.048, 0.10, 0.038), at(0, 0, 0.05), plain(color));
  builder.add(cylinder(0.040, 0.02), at(0, 0, 0.011), plain(color));
  const std::array<Color, 4> colors = {rgb(200, 40, 40), rgb(40, 80, 190), rgb(230, 190, 40),
                                       rgb(40, 140, 70)};
  for (int i = 0; i < 4; ++i) {
    const Pose X_GP = at(0, 0, 0.10, i * kPi / 2 + 0.4) * leaning({0.014, 0, 0}, 0.16);
    builder.add_object("pen", X_WG * X_GP, capsule(0.0075, 0.16), plain(colors[i]));
  }
}

void add_plant(SceneBuilder& builder, const Pose& X_WG, double size) {
  builder.begin_object("plant pot", X_WG);
  builder.add(cone(0.16 * size, 0.24 * size, 0.36 * size), at(0, 0, 0.18 * size),
              textured(Texture::kStripes, rgb(186, 98, 62), rgb(164, 82, 52), 0.12 * size));
  builder.add(torus(0.225 * size, 0.035 * size), at(0, 0, 0.36 * size), plain(rgb(186, 98, 62)));
  builder.begin_object("plant", X_WG);
  builder.add(sphere(0.15 * size), at(0, 0, 0.80 * size), plain(rgb(62, 132, 58)));
  builder.add(capsule(0.025 * size, 0.45 * size), at(0, 0, 0.52 * size), plain(rgb(104, 84, 50)));
  for (int i = 0; i < 6; ++i) {
    const double height = (i % 2 == 0 ? 0.58 : 0.70) * size;
    const Pose X_GL = at(0, 0, height, i * kPi / 3) * leaning({0.15 * size, 0, 0}, 1.0);
    builder.add(capsule(0.055 * size, 0.34 * size), X_GL,
                plain(i % 2 == 0 ? rgb(50, 118, 48) : rgb(84, 156, 66)));
  }
}

void add_globe(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("globe", X_WG);
  builder.add(sphere(0.11), at(0, 0, 0.19),
              textured(Texture::kPicture, rgb(52, 104, 178), rgb(120, 168, 84), 0.09));
  builder.add(cylinder(0.075, 0.02), at(0, 0, 0.01), kDark);
  builder.add(cylinder(0.014, 0.08), at(0, 0, 0.05), kMetal);
}

void add_vase(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("vase", X_WG);
  builder.add(cone(0.045, 0.085, 0.12), at(0, 0, 0.06), plain(color));
  builder.add(cone(0.085, 0.035, 0.10), at(0, 0, 0.17), plain(color));
  builder.add(torus(0.035, 0.010), at(0, 0, 0.222), plain(rgb(240, 232, 216)));
}

void add_tape_roll(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.add_object("tape roll", X_WG * at(0, 0, 0.022), torus(0.045, 0.020), plain(color));
}

void add_carton(SceneBuilder& builder, const Pose& X_WG, const Eigen::Vector3d& size_m) {
  builder.begin_object("carton", X_WG);
  builder.add(box(size_m.x(), size_m.y(), size_m.z()), at(0, 0, size_m.z() / 2),
              textured(Texture::kPlaster, rgb(190, 148, 98), rgb(0, 0, 0), 0.02));
  builder.add(box(0.05, size_m.y() + 0.004, size_m.z() + 0.004), at(0, 0, size_m.z() / 2),
              plain(rgb(222, 200, 150)));
}

void add_ball(SceneBuilder& builder, const Pose& X_WG, double radius, const Color& color) {
  builder.add_object("ball", X_WG * at(0, 0, radius), sphere(radius),
                     textured(Texture::kStripes, color, rgb(240, 240, 236), radius / 2));
}

void add_book(SceneBuilder& builder, const Pose& X_WG, const Eigen::Vector3d& size_m,
              const Color& color) {
  builder.begin_object("book", X_WG);
  builder.add(box(size_m.x(), size_m.y(), size_m.z()), at(0, 0, size_m.z() / 2), plain(color));
  const Eigen::Vector3d pages(size_m.x() + 0.002, size_m.y() - 0.012, size_m.z() - 0.010);
  builder.add(box(pages.x(), pages.y(), pages.z()), at(0, 0.007, size_m.z() / 2),
              plain(rgb(238, 232, 214)));
}

void add_book_stack(SceneBuilder& builder, const Pose& X_WG, int count, CounterRandom& random) {
  double height = 0.0;
  for (int i = 0; i < count; ++i) {
    const double shrink = 1.0 - 0.06 * i;
    const Eigen::Vector3d size(0.24 * shrink, 0.17 * shrink, random.uniform(0.025, 0.045));
    add_book(builder, X_WG * at(0, 0, height, random.uniform(-0.25, 0.25)), size,
             any_color(random));
    height += size.z();
  }
}

void add_book_row(SceneBuilder& builder, const Pose& X_WG, double width_m, double max_height_m,
                  CounterRandom& random) {
  double x = -width_m / 2;
  const double end = width_m / 2 - 0.10;  // room for the one that leans
  while (x < end) {
    const double thick = random.uniform(0.028, 0.055);
    const double height = max_height_m * random.uniform(0.75, 1.0);
    const double depth = random.uniform(0.16, 0.20);
    builder.add_object("book", X_WG * at(x + thick / 2, 0.01 * random.uniform(-1, 1), height / 2),
                       box(thick - 0.002, depth, height),
                       textured(Texture::kBands, any_color(random), any_color(random), 0.1));
    x += thick;
  }
  const double lean_rad = 0.16;
  const double height = 0.7 * max_height_m;
  const Pose X_GB = tilted(at(x + 0.002 + height * std::sin(lean_rad), 0, 0),
                           Eigen::Vector3d::UnitY(), -lean_rad);
  builder.add_object("book", X_WG * X_GB * at(0.015, 0, height / 2), box(0.03, 0.18, height),
                     plain(any_color(random)));
}

void add_any_small_object(SceneBuilder& builder, const Pose& X_WG, CounterRandom& random) {
  const Color color = any_color(random);
  switch (random.integer(0, 11)) {
    case 0:
      return add_mug(builder, X_WG, color);
    case 1:
      return add_bottle(builder, X_WG, color);
    case 2:
      return add_teapot(builder, X_WG, color);
    case 3:
      return add_globe(builder, X_WG);
    case 4:
      return add_vase(builder, X_WG, color);
    case 5:
      return add_book_stack(builder, X_WG, 3, random);
    case 6:
      return add_plant(builder, X_WG, 0.28);
    case 7:
      return add_carton(builder, X_WG, {0.22, 0.16, 0.14});
    case 8:
      return add_ball(builder, X_WG, 0.08, color);
    case 9:
      return add_bowl(builder, X_WG, color);
    case 10:
      return add_speaker(builder, X_WG);
    default:
      return add_pen_holder(builder, X_WG, color);
  }
}

}  // namespace kintsugi::synthetic

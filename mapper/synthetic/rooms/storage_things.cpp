#include "mapper/synthetic/rooms/storage_things.hpp"

namespace kintsugi::synthetic {

namespace {

const Material kDark = plain(rgb(48, 50, 56));
const Material kMetal = plain(rgb(150, 154, 160));

}  // namespace

void add_binder(SceneBuilder& builder, const Pose& X_WG, const Color& color, double lean_rad) {
  const Pose X_GE =
      at(-kBinderWidth_m / 2, 0, 0) * Pose(Eigen::AngleAxisd(-lean_rad, Eigen::Vector3d::UnitY()));
  builder.begin_object("binder", X_WG * X_GE);
  builder.add(box(kBinderWidth_m, 0.23, 0.29), at(kBinderWidth_m / 2, 0, 0.145), plain(color));
  builder.add(box(0.7 * kBinderWidth_m, 0.01, 0.12), at(kBinderWidth_m / 2, -0.111, 0.19),
              plain(rgb(240, 238, 230)));
}

void add_storage_box(SceneBuilder& builder, const Pose& X_WG, const Eigen::Vector3d& size_m,
                     const Material& material) {
  builder.begin_object("storage box", X_WG);
  builder.add(box(size_m.x() - 0.01, size_m.y() - 0.01, size_m.z()), at(0, 0, size_m.z() / 2),
              material);
  builder.add(box(size_m.x(), size_m.y(), 0.04), at(0, 0, size_m.z() - 0.02), material);
}

void add_jar(SceneBuilder& builder, const Pose& X_WG, double height, const Color& color) {
  builder.begin_object("jar", X_WG);
  builder.add(cylinder(kJarRadius_m, height), at(0, 0, height / 2), plain(color));
  builder.add(cylinder(0.8 * kJarRadius_m, 0.02), at(0, 0, height + 0.01), kMetal);
}

void add_toolbox(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("toolbox", X_WG);
  builder.add(box(0.34, 0.18, 0.14), at(0, 0, 0.07), plain(color));
  builder.add(rounded_box(0.35, 0.19, 0.05, 0.015), at(0, 0, 0.155), plain(0.85F * color));
  builder.add(capsule(0.013, 0.20), at(0, 0, 0.225) * axis_along_x(), kDark);
  for (double side : {-1.0, 1.0}) {
    builder.add(box(0.02, 0.02, 0.05), at(side * 0.08, 0, 0.20), kDark);
  }
}

void add_table_clock(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("table clock", X_WG);
  builder.add(cylinder(0.07, 0.05), at(0, 0, 0.08) * axis_along_y(), plain(rgb(236, 232, 220)));
  builder.add(torus(0.068, 0.012), at(0, -0.022, 0.08) * axis_along_y(), kMetal);
  builder.add(box(0.10, 0.06, 0.02), at(0, 0, 0.01), kMetal);
}

void add_tin(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("tin", X_WG);
  builder.add(cylinder(0.045, 0.12), at(0, 0, 0.06),
              textured(Texture::kBands, color, rgb(238, 234, 224), 0.1));
}

void add_computer(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("computer", X_WG);
  builder.add(box(0.19, 0.42, 0.43), at(0, 0, 0.215), plain(rgb(60, 62, 68)));
  builder.add(box(0.15, 0.02, 0.05), at(0, -0.208, 0.36), kMetal);
}

void add_power_strip(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("power strip", X_WG);
  builder.add(rounded_box(0.065, 0.34, 0.05, 0.012), at(0, 0, 0.025), plain(rgb(236, 236, 232)));
}

void add_footrest(SceneBuilder& builder, const Pose& X_WG, const Material& material) {
  builder.begin_object("footrest", X_WG);
  builder.add(box(0.42, 0.30, 0.04),
              at(0, 0, 0.10) * Pose(Eigen::AngleAxisd(0.30, Eigen::Vector3d::UnitX())), material);
  builder.add(box(0.38, 0.06, 0.12), at(0, 0.09, 0.06), material);
}

void add_umbrella(SceneBuilder& builder, const Pose& X_WG, const Eigen::Vector3d& top_G,
                  const Color& color) {
  constexpr double kRadius_m = 0.028;
  Pose X_GU = Pose::Identity();
  X_GU.linear() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), top_G).toRotationMatrix();
  builder.begin_object("umbrella", X_WG * X_GU);
  builder.add(capsule(kRadius_m, 0.8 * top_G.norm()), at(0, 0, 0.42 * top_G.norm()), plain(color));
  builder.add(capsule(0.016, 0.3 * top_G.norm()), at(0, 0, 0.87 * top_G.norm()), kDark);
}

void add_cork_board(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("cork board", X_WG);
  builder.add(box(0.42, 0.025, 0.30), at(0, -0.0125, 0), plain(color));
}

void add_wall_board(SceneBuilder& builder, const Pose& X_WG, double width, const Color& color) {
  builder.begin_object("wall shelf", X_WG);
  builder.add(box(width, kWallBoardDepth_m, 0.03), at(0, -kWallBoardDepth_m / 2, -0.015),
              plain(color));
}

}  // namespace kintsugi::synthetic

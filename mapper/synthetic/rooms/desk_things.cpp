#include "mapper/synthetic/rooms/desk_things.hpp"

#include "mapper/synthetic/rooms/furniture.hpp"

namespace kintsugi::synthetic {

namespace {

const Material kDark = plain(rgb(48, 50, 56));
const Material kMetal = plain(rgb(168, 172, 178));

/// A flat thing. It reaches below what it lies on, unseen, so that a point beneath its surface, to
/// where noise may move it, is still within it and not within what carries it.
void add_flat(SceneBuilder& builder, double size_x, double size_y, double height,
              const Material& material) {
  constexpr double kSunk_m = 0.01;
  builder.add(box(size_x, size_y, height + kSunk_m), at(0, 0, (height - kSunk_m) / 2), material);
}

}  // namespace

void add_mouse_pad(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("mouse pad", X_WG);
  add_flat(builder, 0.22, 0.20, 0.006, plain(rgb(66, 72, 92)));
}

void add_magazine(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("magazine", X_WG);
  add_flat(builder, 0.24, 0.30, kMagazineHeight_m,
           textured(Texture::kPicture, rgb(226, 202, 92), rgb(196, 72, 84), 0.12));
}

void add_notebook(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("notebook", X_WG);
  add_flat(builder, 0.15, 0.21, 0.022, oak());
}

void add_ruler(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("ruler", X_WG);
  add_flat(builder, 0.36, 0.045, 0.008, kMetal);
}

void add_calculator(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("calculator", X_WG);
  add_flat(builder, 0.10, 0.17, 0.022,
           textured(Texture::kKeys, rgb(206, 208, 204), rgb(96, 100, 108), 0.022));
}

void add_stapler(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("stapler", X_WG);
  builder.add(rounded_box(0.17, 0.048, 0.018, 0.006), at(0, 0, 0.009), kDark);
  builder.add(rounded_box(0.16, 0.044, 0.034, 0.012),
              at(-0.004, 0, 0.046) * Pose(Eigen::AngleAxisd(-0.10, Eigen::Vector3d::UnitY())),
              plain(rgb(176, 40, 48)));
  builder.add(box(0.04, 0.030, 0.04), at(-0.055, 0, 0.028), kDark);
}

void add_tissue_box(SceneBuilder& builder, const Pose& X_WG) {
  builder.begin_object("tissue box", X_WG);
  builder.add(box(0.21, 0.11, 0.08), at(0, 0, 0.04),
              textured(Texture::kChecks, rgb(132, 176, 206), rgb(160, 196, 220), 0.03));
  builder.add(cone(0.022, 0.045, 0.05), at(0, 0, 0.10), plain(rgb(246, 246, 246)));
}

void add_spray_can(SceneBuilder& builder, const Pose& X_WG, const Color& color) {
  builder.begin_object("spray can", X_WG);
  builder.add(cylinder(0.033, 0.15), at(0, 0, 0.075), plain(color));
  builder.add(cylinder(0.026, 0.035), at(0, 0, 0.165), plain(rgb(240, 240, 240)));
}

void add_tablet(SceneBuilder& builder, const Pose& X_WG, double lean_rad) {
  const Pose X_GT(Eigen::AngleAxisd(-lean_rad, Eigen::Vector3d::UnitX()));
  builder.begin_object("tablet", X_WG * X_GT);
  builder.add(rounded_box(0.19, 0.014, 0.16, 0.006), at(0, 0, 0.08), kDark);
  builder.add(box(0.165, 0.004, 0.135), at(0, -0.007, 0.08),
              textured(Texture::kScreen, rgb(228, 232, 236), rgb(70, 90, 130), 0.008));
}

void add_letter_tray(SceneBuilder& builder, const Pose& X_WG) {
  constexpr double kWidth_m = 0.23;
  constexpr double kDepth_m = 0.30;
  builder.begin_object("letter tray", X_WG);
  builder.add(box(kWidth_m, kDepth_m, 0.015), at(0, 0, 0.0075), kDark);
  for (double side : {-1.0, 1.0}) {
    builder.add(box(0.008, kDepth_m, 0.05), at(side * (kWidth_m / 2 - 0.004), 0, 0.025), kDark);
  }
  builder.add(box(kWidth_m, 0.008, 0.05), at(0, kDepth_m / 2 - 0.004, 0.025), kDark);
  constexpr double kPaper_m = kLetterTrayHeight_m - 0.015;
  builder.add_object("paper", X_WG * at(0, -0.008, 0.015 + kPaper_m / 2),
                     box(kWidth_m - 0.024, kDepth_m - 0.016, kPaper_m), plain(rgb(240, 238, 232)));
}

}  // namespace kintsugi::synthetic

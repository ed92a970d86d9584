#pragma once
// Things on an office's desk, most of them thin. X_WG as in small_objects.hpp.

#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

void add_mouse_pad(SceneBuilder& builder, const Pose& X_WG);
void add_magazine(SceneBuilder& builder, const Pose& X_WG);
inline constexpr double kMagazineHeight_m = 0.010;
void add_notebook(SceneBuilder& builder, const Pose& X_WG);  ///< of the desk's colour
void add_ruler(SceneBuilder& builder, const Pose& X_WG);     ///< along x
void add_calculator(SceneBuilder& builder, const Pose& X_WG);
void add_stapler(SceneBuilder& builder, const Pose& X_WG);  ///< along x
void add_tissue_box(SceneBuilder& builder, const Pose& X_WG);
void add_spray_can(SceneBuilder& builder, const Pose& X_WG, const Color& color);

/// Stands on its lower edge, its screen towards -y, and leans back by `lean_rad`.
void add_tablet(SceneBuilder& builder, const Pose& X_WG, double lean_rad);

/// With a pile of paper in it, an object of its own.
void add_letter_tray(SceneBuilder& builder, const Pose& X_WG);
inline constexpr double kLetterTrayHeight_m = 0.075;  ///< of the paper's top

}  // namespace kintsugi::synthetic

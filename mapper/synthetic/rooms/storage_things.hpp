#pragma once
// Things in an office's shelves and on its floor. X_WG as in small_objects.hpp.

#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

/// Stands with its spine towards -y; `lean_rad` tips its top towards -x, about its lower left edge.
void add_binder(SceneBuilder& builder, const Pose& X_WG, const Color& color, double lean_rad = 0);
inline constexpr double kBinderWidth_m = 0.075;

/// Without texture, with a lid that stands out by half a centimetre.
void add_storage_box(SceneBuilder& builder, const Pose& X_WG, const Eigen::Vector3d& size_m,
                     const Material& material);
void add_jar(SceneBuilder& builder, const Pose& X_WG, double height, const Color& color);
inline constexpr double kJarRadius_m = 0.042;
void add_toolbox(SceneBuilder& builder, const Pose& X_WG, const Color& color);
void add_table_clock(SceneBuilder& builder, const Pose& X_WG);
void add_tin(SceneBuilder& builder, const Pose& X_WG, const Color& color);

void add_computer(SceneBuilder& builder, const Pose& X_WG);
void add_power_strip(SceneBuilder& builder, const Pose& X_WG);  ///< along y
void add_footrest(SceneBuilder& builder, const Pose& X_WG, const Material& material);

/// Leans: its foot is at G's origin, its handle at `top_G`.
void add_umbrella(SceneBuilder& builder, const Pose& X_WG, const Eigen::Vector3d& top_G,
                  const Color& color);

/// On the wall, as in room_shell.hpp: G's origin in the middle of it, on the wall.
void add_cork_board(SceneBuilder& builder, const Pose& X_WG, const Color& color);
/// On the wall: G's origin in the middle of the board's top edge.
void add_wall_board(SceneBuilder& builder, const Pose& X_WG, double width, const Color& color);
inline constexpr double kWallBoardDepth_m = 0.17;

}  // namespace kintsugi::synthetic

#pragma once
// Floors, walls with doors and windows, and what hangs on walls.

#include <vector>

#include "mapper/synthetic/scene/counter_random.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

inline constexpr double kWallThickness_m = 0.12;
inline constexpr double kRoomHeight_m = 2.5;
inline constexpr double kDoorHeight_m = 2.05;

/// A hole in a wall. One that reaches the floor is a doorway with a frame around it; another is a
/// window with a frame, a bar across and a pane.
struct Opening {
  double middle_m;  ///< along the wall from its start
  double width_m;
  double bottom_m = 0.0;
  double top_m = kDoorHeight_m;
  bool has_door_leaf = false;  ///< a closed door stands in the doorway
};

/// A straight wall around the line from start_W to end_W at its foot, with a skirting on both
/// sides. Openings must lie inside the wall, in ascending order, without overlap.
void add_wall(SceneBuilder& builder, const Eigen::Vector3d& start_W, const Eigen::Vector3d& end_W,
              const Material& material, const std::vector<Opening>& openings = {},
              double height_m = kRoomHeight_m);

/// A slab whose upper side is at top_z, from corner to corner.
void add_slab(SceneBuilder& builder, const char* name, const Eigen::Vector2d& min_W,
              const Eigen::Vector2d& max_W, double top_z, const Material& material);

// On a wall: the object's frame G has its origin on the wall's surface, z up, and looks along -y.
void add_picture(SceneBuilder& builder, const Pose& X_WG, double width, double height,
                 const Color& color, const Color& second_color);
void add_whiteboard(SceneBuilder& builder, const Pose& X_WG, double width);
void add_clock(SceneBuilder& builder, const Pose& X_WG);
void add_radiator(SceneBuilder& builder, const Pose& X_WG, double width);
void add_wall_shelf(SceneBuilder& builder, const Pose& X_WG, double width, CounterRandom& random);
void add_fire_extinguisher(SceneBuilder& builder, const Pose& X_WG);
void add_wall_lamp(SceneBuilder& builder, const Pose& X_WG);
void add_coat_hooks(SceneBuilder& builder, const Pose& X_WG, CounterRandom& random);

}  // namespace kintsugi::synthetic

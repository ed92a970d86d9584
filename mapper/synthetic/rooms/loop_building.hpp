#pragma once
// A building of four rooms around a common corner, each with a doorway to the next, and the way
// through all of them. Quarter k of it is the first one turned by k * 90 degrees.

#include "mapper/synthetic/rooms/rooms.hpp"
#include "mapper/synthetic/rooms/trajectory.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

inline constexpr int kLoopQuarters = 4;
inline constexpr double kLoopRoom_m = 3.4;  ///< clear width and depth of a room

/// X_WR of the room in quarter k: its origin on the floor in the middle, the entrance in the wall
/// at -y, the exit in the one at -x.
Pose loop_room(int k);

/// Walls and floor of quarter k.
void add_loop_quarter(SceneBuilder& builder, int k, RoomKind kind);
void add_loop_ceiling(SceneBuilder& builder);

/// Once through all rooms, back to the doorway where it began; along the outer walls the camera
/// looks at what stands there.
Trajectory loop_path(std::uint32_t seed);

}  // namespace kintsugi::synthetic

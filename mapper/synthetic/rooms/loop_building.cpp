#include "mapper/synthetic/rooms/loop_building.hpp"

#include <array>
#include <numbers>

#include "mapper/synthetic/rooms/room_shell.hpp"
#include "mapper/synthetic/rooms/walk.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr double kMiddle_m = (kLoopRoom_m + kWallThickness_m) / 2;  // of a room, from the corner
constexpr double kOuter_m = kLoopRoom_m + kWallThickness_m;         // axis of the outer walls
constexpr double kPath_m = kMiddle_m + 0.24;                        // the doorways, from the corner

/// Quarter k of the building is the first one turned by k * 90 degrees: x and y from 0 to kOuter_m.
Pose quarter(int k) { return at(0, 0, 0, k * std::numbers::pi / 2); }

/// In at the doorway in the wall at -y of the room, out at the one in the wall at -x; looks at the
/// furniture along the outer walls meanwhile.
void walk_quarter(Walk& walk, int k) {
  const Pose X_WR = loop_room(k);
  const double turned_deg = 90.0 * k;
  const auto go = [&](double x, double y, double heading_deg) {
    walk.to(X_WR * Eigen::Vector3d(x, y, 0), turned_deg + heading_deg);
  };
  go(0.25, -1.20, 75);
  go(0.27, -0.55, 35);
  go(0.20, 0.00, 50);
  go(0.00, 0.25, 95);
  go(-0.55, 0.27, 115);
  go(-1.20, 0.26, 160);
  go(-1.76, 0.24, 180);
}

}  // namespace

Pose loop_room(int k) { return quarter(k) * at(kMiddle_m, kMiddle_m, 0); }

void add_loop_quarter(SceneBuilder& builder, int k, RoomKind kind) {
  const std::array<Color, kLoopQuarters> wall_colors = {rgb(222, 208, 180), rgb(204, 214, 222),
                                                        rgb(226, 222, 206), rgb(208, 218, 200)};
  const Material wall = textured(Texture::kPlaster, wall_colors[k], rgb(0, 0, 0), 0.12);
  const Pose X_WQ = quarter(k);
  add_wall(builder, X_WQ * Eigen::Vector3d(0, 0, 0), X_WQ * Eigen::Vector3d(kOuter_m, 0, 0), wall,
           {{.middle_m = kPath_m, .width_m = 1.0}});
  add_wall(builder, X_WQ * Eigen::Vector3d(kOuter_m, -kOuter_m, 0),
           X_WQ * Eigen::Vector3d(kOuter_m, kOuter_m, 0), wall,
           {{.middle_m = kOuter_m + 2.7, .width_m = 0.8, .bottom_m = 1.1, .top_m = 2.1}});
  Pose X_WM = X_WQ * at(kMiddle_m, kMiddle_m, -0.1);
  builder.add_structure("floor", X_WM, box(kOuter_m, kOuter_m, 0.2), floor_of(kind));
}

void add_loop_ceiling(SceneBuilder& builder) {
  add_slab(builder, "ceiling", {-kOuter_m, -kOuter_m}, {kOuter_m, kOuter_m}, kRoomHeight_m + 0.2,
           plain(rgb(244, 244, 240)));
}

Trajectory loop_path(std::uint32_t seed) {
  Walk walk({kPath_m, 0, 0}, 90);
  for (int k = 0; k < kLoopQuarters; ++k) walk_quarter(walk, k);
  return Trajectory(walk.waypoints(), {.duration_s = 100, .seed = seed});
}

}  // namespace kintsugi::synthetic

#include "tests/bench/map_generator_scene.hpp"

#include "mapper/synthetic/rooms/room_shell.hpp"
#include "mapper/synthetic/rooms/rooms.hpp"

namespace kintsugi::segmenter::bench {
namespace {

using synthetic::at;
using synthetic::SceneBuilder;

constexpr double kWall_m = 0.1;
constexpr double kHeight_m = 2.5;
constexpr double kDoor_m = 1.0;
constexpr double kSide_m = 0.5 * kCorridorWidth_m;  // from the corridor's axis to its walls
constexpr double kDepth_m = kSide_m + kRoomDepth_m;

void add_box(SceneBuilder& builder, double x0, double y0, double z0, double x1, double y1,
             double z1) {
  const Pose X_WG = at(0.5 * (x0 + x1), 0.5 * (y0 + y1), 0.5 * (z0 + z1));
  builder.add_structure("wall", X_WG, synthetic::box(x1 - x0, y1 - y0, z1 - z0),
                        synthetic::plain(synthetic::rgb(220, 220, 215)));
}

/// The walls of one room and of its part of the corridor; `side` is +1 or -1, along y.
void add_room_walls(SceneBuilder& builder, double x0, int side) {
  const double x1 = x0 + kRoomWidth_m;
  const double door0 = x0 + 0.5 * (kRoomWidth_m - kDoor_m);
  const auto [near0, near1] =
      side > 0 ? std::pair(kSide_m, kSide_m + kWall_m) : std::pair(-kSide_m - kWall_m, -kSide_m);
  add_box(builder, x0, near0, 0.0, door0, near1, kHeight_m);
  add_box(builder, door0 + kDoor_m, near0, 0.0, x1, near1, kHeight_m);
  const double far = side * (kDepth_m + 0.5 * kWall_m);
  add_box(builder, x0, far - 0.5 * kWall_m, 0.0, x1, far + 0.5 * kWall_m, kHeight_m);
  const auto [y0, y1] = side > 0 ? std::pair(kSide_m, kDepth_m) : std::pair(-kDepth_m, -kSide_m);
  add_box(builder, x1 - 0.5 * kWall_m, y0, 0.0, x1 + 0.5 * kWall_m, y1, kHeight_m);
}

}  // namespace

synthetic::Scene make_building(int num_rooms, std::uint32_t seed) {
  constexpr std::array kKinds = {synthetic::RoomKind::kOffice,  synthetic::RoomKind::kKitchen,
                                 synthetic::RoomKind::kLiving,  synthetic::RoomKind::kBedroom,
                                 synthetic::RoomKind::kMeeting, synthetic::RoomKind::kStore};
  constexpr double kPi = 3.14159265358979323846;
  const double length_m = corridor_length_m(num_rooms);
  synthetic::CounterRandom random(seed);
  SceneBuilder builder;
  synthetic::add_slab(builder, "floor", {-1.0, -kDepth_m - 1.0}, {length_m + 1.0, kDepth_m + 1.0},
                      0.0, synthetic::plain(synthetic::rgb(150, 140, 130)));
  add_box(builder, -1.0, -kDepth_m - 1.0, kHeight_m, length_m + 1.0, kDepth_m + 1.0,
          kHeight_m + kWall_m);
  for (const double x : {-kWall_m, length_m}) {
    add_box(builder, x, -kDepth_m - kWall_m, 0.0, x + kWall_m, kDepth_m + kWall_m, kHeight_m);
  }
  for (int room = 0; room < 2 * rooms_per_side(num_rooms); ++room) {
    const int side = room % 2 == 0 ? 1 : -1;
    const int place = room / 2;  // along the corridor
    const double x0 = kRoomWidth_m * place;
    add_room_walls(builder, x0, side);
    const double middle_y = side * (kSide_m + 0.5 * (kRoomDepth_m + kWall_m));
    synthetic::furnish(builder, kKinds[static_cast<std::size_t>(room) % kKinds.size()],
                       {.X_WR = at(x0 + 0.5 * kRoomWidth_m, middle_y, 0.0, side > 0 ? 0.0 : kPi),
                        .width_m = kRoomWidth_m - kWall_m,
                        .depth_m = kRoomDepth_m - kWall_m},
                       random);
  }
  return std::move(builder).build();
}

std::vector<std::array<double, 2>> walk_through(int num_rooms) {
  constexpr double kStep_m = 1.2;  // to the left and to the right in a room
  constexpr double kEnd_m = 0.6;   // from the corridor's ends
  std::vector<std::array<double, 2>> corners = {{kEnd_m, 0.0}};
  for (int pair = 0; pair < rooms_per_side(num_rooms); ++pair) {
    const double x = kRoomWidth_m * (pair + 0.5);
    corners.push_back({x, 0.0});
    for (const int side : {1, -1}) {
      const double y = side * (kSide_m + 0.5 * kRoomDepth_m);
      corners.insert(corners.end(), {{x, y}, {x - kStep_m, y}, {x + kStep_m, y}, {x, y}, {x, 0.0}});
    }
  }
  corners.push_back({corridor_length_m(num_rooms) - kEnd_m, 0.0});
  return corners;
}

}  // namespace kintsugi::segmenter::bench

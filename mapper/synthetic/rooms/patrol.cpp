// The building of "loop" with less in it, so that it is soon rendered: a place for long runs, in
// which the same round is walked again and again, and between two rounds something may be moved.
#include <array>
#include <numbers>
#include <utility>

#include "mapper/synthetic/rooms/furniture.hpp"
#include "mapper/synthetic/rooms/loop_building.hpp"
#include "mapper/synthetic/rooms/scene_functions.hpp"
#include "mapper/synthetic/rooms/small_objects.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr std::array<RoomKind, kLoopQuarters> kKinds = {RoomKind::kOffice, RoomKind::kStore,
                                                        RoomKind::kMeeting, RoomKind::kLiving};
constexpr double kTableInset_m = 0.36;  // from the wall to the middle of a table or cabinet
constexpr double kNearWall_m = kLoopRoom_m / 2 - kTableInset_m;

/// Where a thing may stand, in a room: along its outer walls, which are at +x and +y.
struct Spot {
  double x;
  double y;
  double z;
};
constexpr std::array<Spot, 6> kSpots = {{{-0.75, kNearWall_m, kTableHeight_m},
                                         {-0.25, kNearWall_m, kTableHeight_m},
                                         {kNearWall_m, -0.55, kCabinetHeight_m},
                                         {0.75, kNearWall_m, 0.0},
                                         {kNearWall_m, 0.30, 0.0},
                                         {kNearWall_m, 0.85, 0.0}}};
constexpr int kThings = 3;  // in a room

/// The spots of the things of each room, and how they are turned.
struct Place {
  int spot;
  double yaw_rad;
};
using Arrangement = std::array<std::array<Place, kThings>, kLoopQuarters>;

constexpr bool is_taken(const std::array<Place, kThings>& room, int spot) {
  for (const Place& place : room) {
    if (place.spot == spot) return true;
  }
  return false;
}

/// Between two rounds the camera is in the doorway to room 0, from which nothing in the others is
/// seen: in one of those a thing comes to a free spot. Sometimes nothing does.
void rearrange(Arrangement& things, std::uint32_t seed, int lap) {
  CounterRandom random(hash32(seed, static_cast<std::uint32_t>(lap)));
  const int room = random.integer(0, kLoopQuarters - 1);
  if (room == 0) return;
  auto& places = things.at(static_cast<std::size_t>(room));
  Place& place = places.at(static_cast<std::size_t>(random.integer(0, kThings - 1)));
  const int first = random.integer(0, kSpots.size() - 1);
  for (std::size_t i = 0; i < kSpots.size(); ++i) {
    const int spot = static_cast<int>((static_cast<std::size_t>(first) + i) % kSpots.size());
    if (is_taken(places, spot)) continue;
    place = {spot, random.uniform(-0.6, 0.6)};
    return;
  }
}

Arrangement arrangement_in(int lap, std::uint32_t seed) {
  Arrangement things;
  for (auto& room : things) room = {{{0, 0.1}, {2, -0.2}, {4, 0.3}}};
  for (int i = 1; i <= lap; ++i) rearrange(things, seed, i);
  return things;
}

void add_thing(SceneBuilder& builder, int room, int thing, const Pose& X_WG) {
  const std::array<Color, kLoopQuarters> colors = {rgb(190, 60, 50), rgb(46, 92, 178),
                                                   rgb(232, 176, 48), rgb(60, 130, 80)};
  const Color& color = colors.at(static_cast<std::size_t>((room + thing) % kLoopQuarters));
  if (thing == 0) add_carton(builder, X_WG, {0.30, 0.24, 0.22});
  if (thing == 1) add_ball(builder, X_WG, 0.13, color);
  if (thing == 2) add_bin(builder, X_WG, color);
}

void add_room(SceneBuilder& builder, int k, const std::array<Place, kThings>& things) {
  const Pose X_WR = loop_room(k);
  const double quarter_turn = -std::numbers::pi / 2;
  add_loop_quarter(builder, k, kKinds.at(static_cast<std::size_t>(k)));
  add_table(builder, X_WR * at(-0.5, kNearWall_m, 0), 1.2, 0.6);
  add_cabinet(builder, X_WR * at(kNearWall_m, -0.55, 0, quarter_turn), 0.7 + 0.05 * k,
              rgb(170 - 20 * k, 160, 120 + 20 * k));
  add_chair(builder, X_WR * at(1.25, 1.25, 0, 0.5 * k), rgb(120, 90 + 20 * k, 80));
  for (int thing = 0; thing < kThings; ++thing) {
    const Place& place = things.at(static_cast<std::size_t>(thing));
    const Spot& spot = kSpots.at(static_cast<std::size_t>(place.spot));
    add_thing(builder, k, thing, X_WR * at(spot.x, spot.y, spot.z, place.yaw_rad));
  }
}

}  // namespace

Scene patrol_scene_in(int lap, std::uint32_t seed) {
  SceneBuilder builder;
  const Arrangement things = arrangement_in(lap, seed);
  for (int k = 0; k < kLoopQuarters; ++k) {
    add_room(builder, k, things.at(static_cast<std::size_t>(k)));
  }
  add_loop_ceiling(builder);
  return std::move(builder).build();
}

SceneWithPath patrol_scene(std::uint32_t seed) {
  return {patrol_scene_in(0, seed), loop_path(seed)};
}

}  // namespace kintsugi::synthetic

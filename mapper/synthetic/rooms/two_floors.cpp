// An office building: a corridor with rooms on both sides, stairs at its end, and the same above.
//
//   y  |  room  |  room  |  room  |  room  |  passage (upper floor)   |
//   0  |  corridor                          stairs up -> ->  landing  |
//      |  room  |  room  |  room  |  room  |
//      x = 0                               16                       22.6
#include <algorithm>
#include <numbers>
#include <vector>

#include "mapper/synthetic/rooms/furniture.hpp"
#include "mapper/synthetic/rooms/room_shell.hpp"
#include "mapper/synthetic/rooms/rooms.hpp"
#include "mapper/synthetic/rooms/scene_functions.hpp"
#include "mapper/synthetic/rooms/small_objects.hpp"
#include "mapper/synthetic/rooms/walk.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kStorey_m = 2.7;        // floor to floor
constexpr double kCorridorHalf_m = 1.0;  // clear half width
constexpr double kWallAxis_m = kCorridorHalf_m + kWallThickness_m / 2;
constexpr double kRoomPitch_m = 4.0;  // rooms along the corridor
constexpr double kRoomDepth_m = 3.4;
constexpr double kRoomWidth_m = kRoomPitch_m - kWallThickness_m;
constexpr double kCorridorEnd_m = 16.0;  // x where the rooms end
constexpr double kStairsStart_m = 16.8;
constexpr int kSteps = 15;
constexpr double kTread_m = 0.27;
constexpr double kStairsEnd_m = kStairsStart_m + kSteps * kTread_m;
constexpr double kEast_m = 22.6;  // clear end of the landing
constexpr double kNorth_m = 3.3;  // clear side of the passage

const Material kWall = textured(Texture::kPlaster, rgb(226, 220, 204), rgb(0, 0, 0), 0.12);
const Material kCeiling = plain(rgb(244, 244, 240));
const Material kStone = textured(Texture::kTiles, rgb(176, 172, 164), rgb(120, 116, 110), 0.45);
const Material kSteel = plain(rgb(96, 100, 108));

/// A room that the camera visits: `door_x` is also its middle; side +1 is at +y, -1 at -y.
struct Visit {
  double door_x;
  int side;
  RoomKind kind;
};

struct Floor {
  double z;
  std::vector<Visit> visits;  ///< in the order of the walk
};

const std::vector<Floor>& floors() {
  static const std::vector<Floor> kFloors = {
      {0.0,
       {{2, -1, RoomKind::kOffice},
        {6, 1, RoomKind::kMeeting},
        {10, -1, RoomKind::kKitchen},
        {14, 1, RoomKind::kStore}}},
      {kStorey_m,
       {{14, -1, RoomKind::kOffice},
        {10, 1, RoomKind::kLiving},
        {6, -1, RoomKind::kMeeting},
        {2, 1, RoomKind::kBedroom}}},
  };
  return kFloors;
}

RoomPlan plan_of(const Visit& visit, double z) {
  const double y = visit.side * (kWallAxis_m + kWallThickness_m / 2 + kRoomDepth_m / 2);
  return {at(visit.door_x, y, z, visit.side > 0 ? 0.0 : kPi), kRoomWidth_m, kRoomDepth_m, true};
}

void add_room(SceneBuilder& builder, const Visit& visit, double z, CounterRandom& random) {
  const RoomPlan plan = plan_of(visit, z);
  const double x = (kRoomWidth_m + kWallThickness_m) / 2;
  const double back = (kRoomDepth_m + kWallThickness_m) / 2;
  const double front = -kRoomDepth_m / 2;  // the corridor's own wall stands there
  const Color tint = any_color(random);
  const Material wall =
      textured(Texture::kPlaster, 0.72F * rgb(236, 230, 216) + 0.28F * tint, rgb(0, 0, 0), 0.12);
  const auto corner = [&](double rx, double ry) -> Eigen::Vector3d {
    return plan.X_WR * Eigen::Vector3d(rx, ry, 0);
  };
  add_wall(builder, corner(-x, front), corner(-x, back), wall);
  add_wall(builder, corner(-x, back), corner(x, back), wall,
           {{.middle_m = x + 1.25, .width_m = 0.7, .bottom_m = 1.2, .top_m = 2.1}});
  add_wall(builder, corner(x, back), corner(x, front), wall);
  builder.add_structure("floor", plan.X_WR * at(0, 0.03, -0.1),
                        box(2 * x, kRoomDepth_m + 0.06, 0.2), floor_of(visit.kind));
  builder.add_structure("ceiling", plan.X_WR * at(0, 0.03, kRoomHeight_m + 0.05),
                        box(2 * x, kRoomDepth_m + 0.06, 0.1), kCeiling);
  furnish(builder, visit.kind, plan, random);
}

/// One thing on the floor, at most 0.4 m deep, and one on the wall above or beside it.
void add_corridor_things(SceneBuilder& builder, const Pose& X_WG, CounterRandom& random) {
  switch (random.integer(0, 6)) {
    case 0:
      add_bench(builder, X_WG * at(0, -0.24, 0), 1.1);
      add_picture(builder, X_WG * at(0, 0, 1.5), 0.8, 0.5, any_color(random), any_color(random));
      if (random.integer(0, 1) == 0)
        add_backpack(builder, X_WG * at(0.2, -0.24, 0.46), any_color(random));
      break;
    case 1:
      add_plant(builder, X_WG * at(0, -0.32, 0), 1.1);
      add_clock(builder, X_WG * at(0.1, 0, 1.85));
      break;
    case 2:
      add_fire_extinguisher(builder, X_WG * at(-0.3, 0, 0));
      add_picture(builder, X_WG * at(0.2, 0, 1.5), 0.5, 0.7, any_color(random), any_color(random));
      add_bin(builder, X_WG * at(0.35, -0.2, 0), any_color(random));
      break;
    case 3:
      add_cabinet(builder, X_WG * at(0, -0.22, 0), 0.9, any_color(random));
      add_any_small_object(builder, X_WG * at(-0.25, -0.22, kCabinetHeight_m), random);
      add_any_small_object(builder, X_WG * at(0.22, -0.22, kCabinetHeight_m), random);
      add_wall_lamp(builder, X_WG * at(0, 0, 1.75));
      break;
    case 4:
      add_coat_hooks(builder, X_WG * at(0, 0, 1.6), random);
      add_stool(builder, X_WG * at(0.05, -0.28, 0), any_color(random));
      break;
    case 5:
      add_radiator(builder, X_WG, 1.0);
      add_wall_shelf(builder, X_WG * at(0, 0, 1.35), 0.9, random);
      break;
    default:
      add_bookcase(builder, X_WG * at(0, -0.15, 0), 1.0, 1.15, random);
      add_picture(builder, X_WG * at(0, 0, 1.75), 0.7, 0.5, any_color(random), any_color(random));
      break;
  }
}

void add_corridor(SceneBuilder& builder, const Floor& floor, CounterRandom& random) {
  const double z = floor.z;
  for (int side : {1, -1}) {
    std::vector<Opening> doors;
    for (int room = 0; room < 4; ++room) {
      const double x = (room + 0.5) * kRoomPitch_m;
      const bool visited =
          std::any_of(floor.visits.begin(), floor.visits.end(),
                      [&](const Visit& v) { return v.side == side && v.door_x == x; });
      doors.push_back({.middle_m = x, .width_m = 0.95, .has_door_leaf = !visited});
    }
    add_wall(builder, {0, side * kWallAxis_m, z}, {kCorridorEnd_m, side * kWallAxis_m, z}, kWall,
             doors);
    const double yaw = side > 0 ? 0.0 : kPi;
    for (double x : {0.75, 3.45, 4.75, 7.45, 8.75, 11.45, 12.75, 15.3}) {
      add_corridor_things(builder, at(x, side * kCorridorHalf_m, z, yaw), random);
    }
  }
  add_wall(builder, {-kWallThickness_m / 2, -kWallAxis_m, z},
           {-kWallThickness_m / 2, kWallAxis_m, z}, kWall,
           {{.middle_m = kWallAxis_m, .width_m = 1.0, .bottom_m = 1.0, .top_m = 2.1}});
}

void add_steps(SceneBuilder& builder) {
  constexpr double kRise_m = kStorey_m / kSteps;
  builder.begin_structure("stairs", at(0, 0, 0));
  for (int i = 0; i < kSteps; ++i) {
    const double top = (i + 1) * kRise_m;
    const double height = std::min(top, 0.5);
    builder.add(box(kTread_m + 0.03, 2 * kCorridorHalf_m, height),
                at(kStairsStart_m + (i + 0.5) * kTread_m - 0.015, 0, top - height / 2),
                textured(Texture::kStripes, rgb(186, 150, 108), rgb(150, 112, 74), 0.09));
  }
  const double slope = std::atan2(kStorey_m, kSteps * kTread_m);
  const double length = std::hypot(kStorey_m, kSteps * kTread_m) + 0.3;
  for (double side : {-1.0, 1.0}) {
    const Pose X_WR = at((kStairsStart_m + kStairsEnd_m) / 2, side * 0.92, kStorey_m / 2 + 0.95);
    builder.add_structure("handrail",
                          X_WR * Pose(Eigen::AngleAxisd(kPi / 2 - slope, Eigen::Vector3d::UnitY())),
                          capsule(0.03, length), plain(rgb(120, 72, 40)));
  }
}

/// A parapet with a rail on top, from start to end.
void add_parapet(SceneBuilder& builder, const Eigen::Vector3d& start_W,
                 const Eigen::Vector3d& end_W) {
  const Eigen::Vector3d along = end_W - start_W;
  const double length = along.norm();
  builder.begin_structure(
      "parapet", at(start_W.x(), start_W.y(), start_W.z(), std::atan2(along.y(), along.x())));
  builder.add(box(length, 0.08, 0.85), at(length / 2, 0, 0.425),
              textured(Texture::kWood, rgb(176, 128, 82), rgb(146, 100, 60), 0.12));
  builder.add(capsule(0.035, length + 0.1), at(length / 2, 0, 0.93) * axis_along_x(), kSteel);
  for (int i = 0; i <= static_cast<int>(length / 0.8); ++i) {
    builder.add(cylinder(0.025, 0.12), at(0.1 + 0.8 * i, 0, 0.88), kSteel);
  }
}

/// Walls, floors and ceilings around the stairs, the landing and the passage.
void add_stairwell(SceneBuilder& builder, CounterRandom& random) {
  const double east = kEast_m + kWallThickness_m / 2;
  const double north = kNorth_m + kWallThickness_m / 2;
  const Material brick = textured(Texture::kBrick, rgb(170, 92, 70), rgb(206, 196, 182), 0.22);
  for (double z : {0.0, kStorey_m}) {
    add_wall(builder, {kCorridorEnd_m, -kWallAxis_m, z}, {east, -kWallAxis_m, z}, brick);
  }
  add_wall(builder, {kCorridorEnd_m, kWallAxis_m, 0}, {east, kWallAxis_m, 0}, kWall);
  for (double side : {-1.0, 1.0}) {  // between the two walls, beside the slab
    builder.add_structure("wall",
                          at((kCorridorEnd_m + kEast_m) / 2, side * kWallAxis_m, kStorey_m - 0.105),
                          box(kEast_m - kCorridorEnd_m, kWallThickness_m, 0.19), kWall);
  }
  add_wall(builder, {east, -kWallAxis_m, kStorey_m}, {east, north, kStorey_m}, kWall,
           {{.middle_m = 1.1, .width_m = 1.2, .bottom_m = 0.9, .top_m = 2.1}});
  add_wall(builder, {east, north, kStorey_m}, {kCorridorEnd_m, north, kStorey_m}, kWall,
           {{.middle_m = 3.5, .width_m = 1.2, .bottom_m = 1.0, .top_m = 2.1}});
  add_wall(builder, {kCorridorEnd_m - 0.06, north, kStorey_m},
           {kCorridorEnd_m - 0.06, kWallAxis_m + 0.06, kStorey_m}, kWall);
  add_steps(builder);
  add_parapet(builder, {kStairsStart_m + 0.04, -kCorridorHalf_m, kStorey_m},
              {kStairsStart_m + 0.04, kCorridorHalf_m + 0.02, kStorey_m});
  add_parapet(builder, {kStairsStart_m, kWallAxis_m, kStorey_m},
              {kStairsEnd_m, kWallAxis_m, kStorey_m});

  const double z = kStorey_m;
  add_picture(builder, at(18.2, -kCorridorHalf_m, 2.6, kPi), 0.9, 0.6, rgb(60, 110, 160),
              rgb(240, 200, 90));
  add_picture(builder, at(19.8, -kCorridorHalf_m, 3.9, kPi), 0.6, 0.8, rgb(150, 60, 60),
              rgb(236, 220, 190));
  add_wall_lamp(builder, at(17.6, kCorridorHalf_m, 1.9));
  add_plant(builder, at(22.2, -0.65, z), 1.1);
  add_bench(builder, at(22.3, 1.7, z, -kPi / 2), 1.1);
  add_cabinet(builder, at(20.6, 3.06, z), 1.0, rgb(80, 120, 130));
  add_any_small_object(builder, at(20.4, 3.06, z + kCabinetHeight_m), random);
  add_globe(builder, at(20.85, 3.06, z + kCabinetHeight_m));
  add_round_table(builder, at(17.6, 2.75, z), 0.35, kTableHeight_m);
  add_bowl(builder, at(17.6, 2.75, z + kTableHeight_m), rgb(226, 222, 210));
  add_plant(builder, at(16.4, 2.9, z), 1.0);
  add_coat_hooks(builder, at(18.4, kNorth_m, z + 1.6), random);
  add_picture(builder, at(kCorridorEnd_m, 2.2, z + 1.5, kPi / 2), 0.8, 0.6, rgb(220, 110, 60),
              rgb(60, 60, 110));
  add_radiator(builder, at(kCorridorEnd_m, 1.95, z, kPi / 2), 0.9);
}

void add_slabs(SceneBuilder& builder) {
  const double edge = kWallAxis_m;
  const double roof = 2 * kStorey_m;
  const double north = kNorth_m + 0.1;
  add_slab(builder, "floor", {-0.1, -edge}, {kStairsEnd_m, edge}, 0, kStone);
  add_slab(builder, "floor", {-0.1, -edge}, {kStairsStart_m, edge}, kStorey_m, kStone);
  add_slab(builder, "floor", {kCorridorEnd_m - 0.1, edge}, {kStairsEnd_m, north}, kStorey_m,
           kStone);
  add_slab(builder, "floor", {kStairsEnd_m, -edge}, {kEast_m + 0.1, north}, kStorey_m, kStone);
  add_slab(builder, "ceiling", {-0.1, -edge}, {kEast_m + 0.1, edge}, roof, kCeiling);
  add_slab(builder, "ceiling", {kCorridorEnd_m - 0.1, edge}, {kEast_m + 0.1, north}, roof,
           kCeiling);
}

/// From the corridor into a room, round by the left, and out again.
void walk_visit(Walk& walk, const Visit& visit, double z) {
  const RoomPlan plan = plan_of(visit, z);
  const double turned_deg = visit.side > 0 ? 0.0 : 180.0;
  const auto go = [&](double x, double y, double heading_deg) {
    walk.to(plan.X_WR * Eigen::Vector3d(x, y, 0), turned_deg + heading_deg);
  };
  go(0.00, -2.30, 90);
  go(-0.10, -1.30, 105);
  go(-0.40, -0.55, 130);
  go(-0.40, 0.00, 105);
  go(0.00, 0.25, 65);
  go(0.40, -0.05, 25);
  go(0.35, -0.60, -10);
  go(0.05, -1.20, -60);
  go(0.00, -2.10, -90);
}

/// Along the corridor to the door of the next room, looking at one side and then the other.
void walk_corridor(Walk& walk, double from_x, double to_x, double z) {
  const double direction = to_x > from_x ? 1.0 : -1.0;
  const double along_deg = direction > 0 ? 0.0 : 180.0;
  double swing_deg = 38.0;
  for (double x = from_x + direction; direction * (to_x - x) > 0.5; x += direction) {
    walk.to({x, 0.08 * (swing_deg > 0 ? -1 : 1), z}, along_deg + swing_deg);
    swing_deg = -swing_deg;
  }
}

void walk_floor(Walk& walk, const Floor& floor, double from_x) {
  for (const Visit& visit : floor.visits) {
    walk_corridor(walk, from_x, visit.door_x, floor.z);
    walk_visit(walk, visit, floor.z);
    from_x = visit.door_x;
  }
}

void walk_stairs(Walk& walk) {
  const double z = kStorey_m;
  walk.to({kStairsStart_m - 0.6, 0, 0}, 0, -10)
      .to({kStairsStart_m, 0, 0}, 8, -4)
      .to({(kStairsStart_m + kStairsEnd_m) / 2, 0.1, z / 2}, -10, -8)
      .to({kStairsEnd_m + 0.1, 0, z}, 5, -18)
      .to({kStairsEnd_m + 0.55, 0.25, z}, 40)
      .to({kStairsEnd_m + 0.75, 1.1, z}, 90)
      .to({kStairsEnd_m + 0.45, 1.9, z}, 140)
      .to({kStairsEnd_m - 0.5, 2.1, z}, 170)
      .to({18.8, 2.0, z}, 215)
      .to({17.4, 1.95, z}, 180)
      .to({16.6, 1.55, z}, 225)
      .to({16.35, 0.7, z}, 240)
      .to({15.9, 0.15, z}, 205);
}

}  // namespace

SceneWithPath two_floors_scene(std::uint32_t seed) {
  SceneBuilder builder;
  CounterRandom random(2014);
  for (const Floor& floor : floors()) {
    add_corridor(builder, floor, random);
    for (const Visit& visit : floor.visits) add_room(builder, visit, floor.z, random);
  }
  add_stairwell(builder, random);
  add_slabs(builder);

  Walk walk({kCorridorEnd_m - 1, 0, 0}, 150);
  walk_corridor(walk, kCorridorEnd_m - 1, 0.3, 0);
  walk.to({0.9, 0, 0}, 120).to({1.0, 0, 0}, 20);
  walk_floor(walk, floors()[0], 1.0);
  walk_corridor(walk, floors()[0].visits.back().door_x, kStairsStart_m - 0.6, 0);
  walk_stairs(walk);
  walk_floor(walk, floors()[1], 15.9);
  walk_corridor(walk, floors()[1].visits.back().door_x, 7.0, kStorey_m);
  return {std::move(builder).build(),
          Trajectory(walk.waypoints(), {.duration_s = 508, .seed = seed})};
}

}  // namespace kintsugi::synthetic

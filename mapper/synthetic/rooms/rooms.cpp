#include "mapper/synthetic/rooms/rooms.hpp"

#include <numbers>

#include "mapper/synthetic/rooms/furniture.hpp"
#include "mapper/synthetic/rooms/room_shell.hpp"
#include "mapper/synthetic/rooms/small_objects.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr double kPi = std::numbers::pi;

/// Places along the walls of a room: `inset` is from the wall to the object's origin.
class Places {
 public:
  explicit Places(const RoomPlan& plan) : plan_(plan) {}

  Pose back(double x, double inset, double z = 0) const {
    return plan_.X_WR * at(x, plan_.depth_m / 2 - inset, z);
  }
  Pose right(double y, double inset, double z = 0) const {
    return plan_.X_WR * at(plan_.width_m / 2 - inset, y, z, -kPi / 2);
  }
  Pose left(double y, double inset, double z = 0) const {
    return plan_.X_WR * at(-plan_.width_m / 2 + inset, y, z, kPi / 2);
  }
  /// Beside the entrance; it is in the middle of this wall, or somewhat to the right.
  Pose front(double x, double inset, double z = 0) const {
    return plan_.X_WR * at(x, -plan_.depth_m / 2 + inset, z, kPi);
  }

 private:
  RoomPlan plan_;
};

void furnish_office(SceneBuilder& b, const RoomPlan&, const Places& places, CounterRandom& random) {
  const Pose X_WD = places.back(-0.45, 0.42);
  const Pose X_WT = X_WD * at(0, 0, kDeskHeight_m);
  add_desk(b, X_WD, 1.5, 0.74);
  add_monitor(b, X_WT * at(0, 0.18, 0, random.uniform(-0.2, 0.2)));
  add_keyboard(b, X_WT * at(0, -0.14, 0));
  add_mouse(b, X_WT * at(0.32, -0.14, 0));
  add_desk_lamp(b, X_WT * at(-0.56, 0.18, 0, -0.4), any_color(random));
  add_mug(b, X_WT * at(0.48, 0.0, 0, -0.6), any_color(random));
  add_book_stack(b, X_WT * at(0.56, 0.22, 0), 3, random);
  add_phone(b, X_WT * at(-0.50, -0.15, 0, 0.3));
  add_office_chair(b, X_WD * at(-0.1, -0.72, 0, kPi + random.uniform(-0.6, 0.6)),
                   any_color(random));
  add_bin(b, places.back(0.52, 0.25), rgb(110, 116, 122));
  add_picture(b, places.back(-0.4, 0, 1.65), 0.7, 0.5, any_color(random), any_color(random));
  add_bookcase(b, places.right(0.75, 0.15), 0.9, 1.85, random);
  add_cabinet(b, places.right(-0.55, 0.22), 0.8, rgb(206, 206, 196));
  add_plant(b, places.right(-0.40, 0.22, kCabinetHeight_m), 0.5);
  add_any_small_object(b, places.right(-0.78, 0.22, kCabinetHeight_m), random);
}

void furnish_kitchen(SceneBuilder& b, const RoomPlan& plan, const Places& places,
                     CounterRandom& random) {
  const double counter = plan.width_m - 1.0;
  const Pose X_WC = places.back(-0.45, 0.33);
  const Pose X_WT = X_WC * at(0, 0, kCounterHeight_m);
  add_counter(b, X_WC, counter);
  add_cooking_pot(b, X_WT * at(-0.8, 0.02, 0), rgb(196, 60, 50));
  add_cooking_pot(b, X_WT * at(-0.45, 0.08, 0, 0.5), rgb(160, 164, 170));
  add_teapot(b, X_WT * at(0.0, 0.0, 0, 0.4), any_color(random));
  add_mug(b, X_WT * at(0.28, -0.08, 0, 0.8), any_color(random));
  add_mug(b, X_WT * at(0.42, 0.02, 0, -0.5), any_color(random));
  add_bottle(b, X_WT * at(0.66, 0.15, 0), rgb(60, 110, 60));
  add_bottle(b, X_WT * at(0.78, 0.12, 0), rgb(190, 150, 50));
  add_bowl(b, X_WT * at(0.95, -0.08, 0), rgb(230, 226, 214));
  add_wall_shelf(b, places.back(-0.3, 0, 1.50), 1.2, random);
  add_fridge(b, places.back(plan.width_m / 2 - 0.38, 0.36));
  add_round_table(b, places.right(0.05, 0.48), 0.40, kTableHeight_m);
  add_bowl(b, places.right(0.05, 0.48, kTableHeight_m), any_color(random));
  add_bottle(b, places.right(0.22, 0.34, kTableHeight_m), any_color(random));
  add_chair(b, places.right(-0.62, 0.40) * at(0, 0, 0, -1.4), any_color(random));
  add_clock(b, places.right(0.1, 0, 1.75));
}

void furnish_living(SceneBuilder& b, const RoomPlan&, const Places& places, CounterRandom& random) {
  add_sofa(b, places.back(-0.2, 0.45), 1.8, any_color(random));
  add_picture(b, places.back(-0.2, 0, 1.6), 1.0, 0.6, any_color(random), any_color(random));
  add_floor_lamp(b, places.back(1.15, 0.30), rgb(244, 224, 170));
  add_cabinet(b, places.right(0.05, 0.22), 1.0, rgb(150, 100, 64));
  add_vase(b, places.right(0.35, 0.22, kCabinetHeight_m), any_color(random));
  add_globe(b, places.right(0.0, 0.22, kCabinetHeight_m));
  add_book_stack(b, places.right(-0.30, 0.22, kCabinetHeight_m), 4, random);
  add_picture(b, places.right(0.05, 0, 1.55), 0.5, 0.6, any_color(random), any_color(random));
  add_plant(b, places.right(-0.85, 0.32), 1.0);
}

void furnish_bedroom(SceneBuilder& b, const RoomPlan& plan, const Places& places,
                     CounterRandom& random) {
  add_bed(b, places.right(0.62, 1.04), any_color(random));
  add_cabinet(b, places.back(0.05, 0.24), 0.5, rgb(190, 160, 120));
  add_desk_lamp(b, places.back(0.08, 0.22, kCabinetHeight_m), any_color(random));
  add_book(b, places.back(-0.10, 0.28, kCabinetHeight_m) * at(0, 0, 0, 0.4), {0.2, 0.14, 0.035},
           any_color(random));
  const Pose X_WD = places.back(-plan.width_m / 2 + 0.75, 0.22);
  add_cabinet(b, X_WD, 1.2, rgb(214, 206, 190));
  add_vase(b, X_WD * at(-0.4, 0, kCabinetHeight_m), any_color(random));
  add_plant(b, X_WD * at(0.38, 0, kCabinetHeight_m), 0.4);
  add_carton(b, X_WD * at(0.0, 0.02, kCabinetHeight_m, 0.2), {0.3, 0.2, 0.14});
  add_picture(b, places.back(-plan.width_m / 2 + 0.75, 0, 1.55), 0.5, 0.7, any_color(random),
              any_color(random));
  add_wall_shelf(b, places.back(0.25, 0, 1.50), 0.9, random);
  add_picture(b, places.right(0.6, 0, 1.6), 0.8, 0.5, any_color(random), any_color(random));
  add_backpack(b, places.right(-0.45, 0.25), any_color(random));
  add_ball(b, places.right(-0.85, 0.30), 0.13, any_color(random));
}

void furnish_meeting(SceneBuilder& b, const RoomPlan&, const Places& places,
                     CounterRandom& random) {
  const Pose X_WD = places.back(-0.25, 0.80);
  const Pose X_WT = X_WD * at(0, 0, kTableHeight_m);
  add_table(b, X_WD, 1.5, 0.7);
  add_laptop(b, X_WT * at(-0.35, -0.05, 0, 0.3));
  add_laptop(b, X_WT * at(0.40, 0.10, 0, kPi - 0.2));
  add_mug(b, X_WT * at(0.05, -0.15, 0), any_color(random));
  add_bowl(b, X_WT * at(0.05, 0.15, 0), any_color(random));
  for (double x : {-0.4, 0.4}) {
    add_chair(b, X_WD * at(x, 0.42, 0, random.uniform(-0.2, 0.2)), any_color(random));
  }
  add_chair(b, X_WD * at(1.02, 0.0, 0, -kPi / 2), any_color(random));
  add_whiteboard(b, places.back(-0.2, 0, 1.5), 1.5);
  add_wall_shelf(b, places.right(0.0, 0, 1.45), 1.0, random);
  add_cabinet(b, places.right(-0.1, 0.22), 0.9, rgb(90, 120, 150));
  add_plant(b, places.right(0.12, 0.22, kCabinetHeight_m), 0.45);
  add_speaker(b, places.right(-0.3, 0.22, kCabinetHeight_m));
}

void add_carton_pile(SceneBuilder& b, const Pose& X_WG, CounterRandom& random) {
  double z = 0;
  for (int i = 0; i < 3; ++i) {
    const double shrink = 1.0 - 0.2 * i;
    const Eigen::Vector3d size(0.5 * shrink, 0.4 * shrink, random.uniform(0.22, 0.36));
    add_carton(b, X_WG * at(0, 0, z, random.uniform(-0.3, 0.3)), size);
    z += size.z();
  }
  add_any_small_object(b, X_WG * at(0, 0, z), random);
}

void furnish_store(SceneBuilder& b, const RoomPlan&, const Places& places, CounterRandom& random) {
  add_bookcase(b, places.back(-0.95, 0.16), 1.0, 1.85, random);
  add_bookcase(b, places.back(0.1, 0.16), 1.0, 1.5, random);
  add_carton_pile(b, places.back(1.1, 0.35), random);
  add_carton_pile(b, places.right(0.15, 0.32), random);
  add_stool(b, places.right(-0.42, 0.30), any_color(random));
  add_teapot(b, places.right(-0.42, 0.30, 0.50), any_color(random));
  add_bin(b, places.right(-0.85, 0.30), any_color(random));
  add_traffic_cone(b, places.back(1.25, 0.85));
}

void furnish_left(SceneBuilder& b, RoomKind kind, const Places& places, CounterRandom& random) {
  if (kind == RoomKind::kKitchen || kind == RoomKind::kStore) {
    add_carton_pile(b, places.left(-0.1, 0.35), random);
    add_coat_hooks(b, places.left(-0.9, 0, 1.6), random);
  } else {
    add_radiator(b, places.left(0.0, 0), 0.9);
    add_picture(b, places.left(0.0, 0, 1.55), 0.6, 0.6, any_color(random), any_color(random));
    add_cabinet(b, places.left(-0.85, 0.22), 0.6, any_color(random));
    add_any_small_object(b, places.left(-0.85, 0.22, kCabinetHeight_m), random);
  }
}

void furnish_entrance(SceneBuilder& b, const Places& places, CounterRandom& random) {
  add_plant(b, places.front(-1.35, 0.35), 0.8);
  add_picture(b, places.front(-1.0, 0, 1.5), 0.6, 0.5, any_color(random), any_color(random));
  add_coat_rack(b, places.front(1.33, 0.32));
}

}  // namespace

Material floor_of(RoomKind kind) {
  switch (kind) {
    case RoomKind::kOffice:
      return textured(Texture::kCarpet, rgb(84, 100, 122), rgb(108, 124, 146), 0.012);
    case RoomKind::kKitchen:
      return textured(Texture::kTiles, rgb(206, 200, 186), rgb(130, 124, 116), 0.30);
    case RoomKind::kLiving:
      return textured(Texture::kWood, rgb(170, 122, 78), rgb(140, 96, 58), 0.14);
    case RoomKind::kBedroom:
      return textured(Texture::kCarpet, rgb(168, 144, 128), rgb(188, 166, 150), 0.012);
    case RoomKind::kMeeting:
      return textured(Texture::kChecks, rgb(132, 140, 132), rgb(112, 120, 112), 0.45);
    case RoomKind::kStore:
      return textured(Texture::kPlaster, rgb(156, 154, 150), rgb(0, 0, 0), 0.1);
  }
  return {};
}

void furnish(SceneBuilder& builder, RoomKind kind, const RoomPlan& plan, CounterRandom& random) {
  const Places places(plan);
  switch (kind) {
    case RoomKind::kOffice:
      furnish_office(builder, plan, places, random);
      break;
    case RoomKind::kKitchen:
      furnish_kitchen(builder, plan, places, random);
      break;
    case RoomKind::kLiving:
      furnish_living(builder, plan, places, random);
      break;
    case RoomKind::kBedroom:
      furnish_bedroom(builder, plan, places, random);
      break;
    case RoomKind::kMeeting:
      furnish_meeting(builder, plan, places, random);
      break;
    case RoomKind::kStore:
      furnish_store(builder, plan, places, random);
      break;
  }
  if (plan.left_is_free) furnish_left(builder, kind, places, random);
  furnish_entrance(builder, places, random);
}

}  // namespace kintsugi::synthetic

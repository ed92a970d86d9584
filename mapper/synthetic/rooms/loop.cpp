// Four furnished rooms around a common corner: a walk through all of them ends where it began.
#include <array>

#include "mapper/synthetic/rooms/loop_building.hpp"
#include "mapper/synthetic/rooms/scene_functions.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr std::array<RoomKind, kLoopQuarters> kKinds = {RoomKind::kLiving, RoomKind::kOffice,
                                                        RoomKind::kKitchen, RoomKind::kBedroom};

}  // namespace

SceneWithPath loop_scene(std::uint32_t seed) {
  SceneBuilder builder;
  CounterRandom random(7);
  for (int k = 0; k < kLoopQuarters; ++k) {
    add_loop_quarter(builder, k, kKinds[k]);
    furnish(builder, kKinds[k], {loop_room(k), kLoopRoom_m, kLoopRoom_m, false}, random);
  }
  add_loop_ceiling(builder);
  return {std::move(builder).build(), loop_path(seed)};
}

}  // namespace kintsugi::synthetic

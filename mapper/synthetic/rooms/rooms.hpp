#pragma once
// Furnished rooms, by kind.

#include "mapper/synthetic/scene/counter_random.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {

enum class RoomKind { kOffice, kKitchen, kLiving, kBedroom, kMeeting, kStore };

/// A rectangle of floor between walls, at least 3.2 m x 3.2 m. The room's frame R has its origin on
/// the floor in the middle; the entrance is in the wall at -y, the back wall is at +y.
struct RoomPlan {
  Pose X_WR = Pose::Identity();
  double width_m = 3.4;      ///< along x
  double depth_m = 3.4;      ///< along y
  bool left_is_free = true;  ///< furniture may stand along the wall at -x
};

/// Puts furniture, and things on it, along the walls. The middle, 1 m across, and the way from the
/// entrance to it stay free.
void furnish(SceneBuilder& builder, RoomKind kind, const RoomPlan& plan, CounterRandom& random);

/// A different floor for each kind.
Material floor_of(RoomKind kind);

}  // namespace kintsugi::synthetic

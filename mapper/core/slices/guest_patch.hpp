#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/loop_closure/map_deformation.hpp"

namespace kintsugi::mapper {

/// A patch of a guest, another mapper that joins this map: one of its revisions.
struct GuestPatch {
  /// Of all its revisions.
  struct Name {
    std::int64_t session = 0;  ///< of the guest
    std::int32_t id = 0;       ///< of the patch there
    auto operator<=>(const Name&) const = default;
  };

  Name name;
  SeenAt at;                     ///< the guest's keyframe with which it moves, here
  Pose X_UP = Pose::Identity();  ///< of the guest's uncorrected map, in which the points are
  bool in_volume = false;        ///< of the guest
  std::vector<CloudPoint> points_P = {};
};

}  // namespace kintsugi::mapper

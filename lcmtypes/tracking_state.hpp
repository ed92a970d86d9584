#pragma once

#include <cstdint>
#include <string_view>

namespace kintsugi {

/// How the mapper knows the camera's pose at a frame.
enum class TrackingState : std::int8_t {
  kStarting = 0,  ///< no frame is fused yet
  kTracking = 1,  ///< registered against the map
  kLost = 2,      ///< the pose is the last one that was known; nothing is fused
  kGiven = 3,     ///< the pose comes from a trajectory file
};

/// True when the pose of the frame is known: the state is kTracking or kGiven.
constexpr bool is_located(TrackingState state) {
  return state == TrackingState::kTracking || state == TrackingState::kGiven;
}

/// "starting", "tracking", "lost" or "given".
constexpr std::string_view to_string(TrackingState state) {
  switch (state) {
    case TrackingState::kStarting:
      return "starting";
    case TrackingState::kTracking:
      return "tracking";
    case TrackingState::kLost:
      return "lost";
    case TrackingState::kGiven:
      return "given";
  }
  return "unknown";
}

}  // namespace kintsugi

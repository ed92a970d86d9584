#pragma once
// A furnished room as labelled points on analytic surfaces, cut into slices as a mapper would.

#include <cstdint>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::viewer {

struct SyntheticMap {
  std::vector<CloudSlice> slices;      ///< the last is kFinal
  std::vector<SegmentUpdate> updates;  ///< one per slice, with the true objects as segments
  std::vector<CameraPose> poses;       ///< a walk along the room's z, 30 Hz
  std::vector<CameraView> views;       ///< what the camera sees on it; may be empty
};

/// A room 5 m wide and 2.6 m high along `length_m` of W's z, sampled every `resolution_m` with a
/// little noise (seed fixed). Floor, walls, ceiling, and a desk with a ball and a box every 2.5 m;
/// each is one segment. The camera starts at W's origin, 1.3 m above the floor and level.
SyntheticMap make_room(double length_m, double resolution_m);

}  // namespace kintsugi::viewer

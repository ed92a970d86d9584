#pragma once
// The intrinsics of a camera in LCM messages.

#include "lcmtypes/codec/check.hpp"
#include "lcmtypes/geometry.hpp"

namespace kintsugi::codec {

/// All but the distortion. From a message or to it.
template <class From, class To>
void copy_intrinsics(const From& from, To& to) {
  to.fx = from.fx;
  to.fy = from.fy;
  to.cx = from.cx;
  to.cy = from.cy;
  to.width = from.width;
  to.height = from.height;
}

void check_intrinsics(const Check& check, const Intrinsics& intrinsics);

}  // namespace kintsugi::codec

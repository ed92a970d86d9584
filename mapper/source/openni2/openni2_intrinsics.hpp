#pragma once

#include <OpenNI.h>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::mapper {

/// Of the depth images of a device: its own calibration when it is ours; otherwise from the field
/// of view alone, the principal point in the middle as OpenNI2's own CoordinateConverter has it.
///
/// Where colour is used, depth is registered to it and so is what the colour camera would
/// measure: its field of view counts. Both cameras tell the view of an image of depth's shape, also
/// where colour is taller (PrimeSense's 1280x1024).
/// @param color null when it is not used.
/// @throws std::runtime_error when the device does not tell its field of view.
Intrinsics intrinsics_of(const openni::Device& device, const openni::VideoStream& depth,
                         const openni::VideoStream* color);

}  // namespace kintsugi::mapper

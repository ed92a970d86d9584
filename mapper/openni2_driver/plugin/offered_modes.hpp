#pragma once

#include <vector>

#include "mapper/openni2_driver/plugin/oni_driver_api.hpp"
#include "mapper/openni2_driver/recording/camera_imitation.hpp"
#include "mapper/openni2_driver/recording/recording.hpp"

namespace kintsugi::mapper {

/// The modes of the depth and colour stream of a device; empty if it has no such stream.
std::vector<OniVideoMode> offered_depth_modes(const Recording& recording,
                                              const CameraImitation& imitation);
std::vector<OniVideoMode> offered_color_modes(const Recording& recording,
                                              const CameraImitation& imitation);

}  // namespace kintsugi::mapper

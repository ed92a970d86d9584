#pragma once

#include <string>

#include "lcmtypes/trajectory.hpp"

namespace kintsugi::mapper {

/// The camera path that comes with a recording, at its depth images; empty when it has none, or the
/// device is no recording of ours (a .oni file, a camera, the bus).
/// @param device as SourceConfig::device
/// @throws as open_recording()
Trajectory recorded_poses(const std::string& device);

}  // namespace kintsugi::mapper

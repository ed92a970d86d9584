#pragma once
// What is known of the noise of common depth cameras before it is measured.

#include <optional>
#include <string_view>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/depth_noise.hpp"

namespace kintsugi::mapper {

/// The names that noise_of_sensor() knows, for messages.
inline constexpr std::string_view kSensorNames = "structured-light, stereo or phone-lidar";

/// Nothing if the name is unknown.
std::optional<DepthNoise> noise_of_sensor(std::string_view name);

/// By the size of the image alone: phones have 256x192 pixels; all others count as structured
/// light.
DepthNoise typical_noise(const Intrinsics& intrinsics);

}  // namespace kintsugi::mapper

#pragma once
// Which imitated cameras are connected.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kintsugi::mapper::camera_ports {

// This state belongs to the process and outlives the driver, which OpenNI2 unloads with its last
// user.

/// Disconnects the camera at an address.
/// @param utime time of the last image, in the recording
/// @param away duration; absent: forever
/// @param new_uri its address afterwards, which may be the same
void unplug(const std::string& uri, std::int64_t utime,
            std::optional<std::chrono::microseconds> away, const std::string& new_uri);

/// The addresses of the connected cameras among those in the environment variable KINTSUGI_CAMERAS
/// (separated by blanks).
std::vector<std::string> listed();

/// False while the camera is disconnected.
bool is_plugged_in(const std::string& uri);

/// The time in the recording at which a camera continues that is back after an interruption. Absent
/// for any other camera, and from the second call on.
std::optional<std::int64_t> take_resume_utime(const std::string& uri);

}  // namespace kintsugi::mapper::camera_ports

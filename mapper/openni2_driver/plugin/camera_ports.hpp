#pragma once
// Where imitated cameras are plugged in, or not.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kintsugi::mapper::camera_ports {

// One process, one set of ports: it outlives the driver, which OpenNI2 ends with its last user.

/// The camera at an address goes away.
/// @param utime of the last image, in the recording's time.
/// @param away absent: for good.
/// @param new_uri its address when it is back, which may be the same.
void unplug(const std::string& uri, std::int64_t utime,
            std::optional<std::chrono::microseconds> away, const std::string& new_uri);

/// The addresses of the cameras that are plugged in, of those that the environment variable
/// KINTSUGI_CAMERAS lists (separated by blanks).
std::vector<std::string> listed();

/// False while the camera is away.
bool is_plugged_in(const std::string& uri);

/// For a camera that was away and is back: the time in the recording at which it goes on. Absent
/// for any other; and when asked again, for it is opened now like any other.
std::optional<std::int64_t> take_resume_utime(const std::string& uri);

}  // namespace kintsugi::mapper::camera_ports

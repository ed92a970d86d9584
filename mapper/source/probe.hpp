#pragma once

#include <string>

namespace kintsugi::mapper {

/// What a recording is: format, cameras, length, poses, how it is read, and what is missing of it.
/// Lines for people, ending with a line feed. Few images are decoded.
/// @param device a path or an address, as SourceConfig::device; not of a camera or the bus
/// @throws std::runtime_error naming the file and what is wrong when it cannot be opened,
///   std::invalid_argument when the device is no recording
std::string probe_recording(const std::string& device);

}  // namespace kintsugi::mapper

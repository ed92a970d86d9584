#pragma once

#include <string>

namespace kintsugi::mapper {

/// What there is and what it offers, for people: for the device of a URI, or for every camera that
/// is plugged in, its URI, name, the modes of its streams and whether it registers depth to colour.
/// @param uri as OpenNI2 has it; empty: every camera
/// @throws std::runtime_error when OpenNI2 cannot be initialised, the one device not be opened, or
/// it is a file.
std::string list_devices(const std::string& uri);

}  // namespace kintsugi::mapper

#pragma once

#include <string>

namespace kintsugi::mapper {

/// A text for people about one device, or every connected camera: URI, name, modes of its streams,
/// and whether it registers depth to colour.
/// @param uri as OpenNI2 lists it; empty: every camera
/// @throws std::runtime_error when OpenNI2 cannot be initialised, or the device cannot be opened or
///   is a file
std::string list_devices(const std::string& uri);

}  // namespace kintsugi::mapper

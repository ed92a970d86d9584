#pragma once
// Opens what --device names: a camera, a device of our driver, or a file.

#include <memory>
#include <string>

#include "mapper/source/openni2/openni2_device.hpp"

namespace kintsugi::mapper {

/// Whether `device` is the path of a file or a folder and not the URI of a device.
bool names_a_file(const std::string& device);

/// The address of a device of our driver for a recording's path; other devices as they are.
std::string driver_address(const std::string& device);

/// Opens the device that `config.device` names. Of a truncated .oni file it opens a repaired copy
/// in the folder for temporary files, which is removed once it is open.
/// @param damage output: what is wrong with a .oni file, and how much of it is left; empty: nothing
/// @throws std::runtime_error naming the device or file and what is wrong with it
std::unique_ptr<OpenNi2Device> open_device(const SourceConfig& config, std::string& damage);

/// The intrinsics from `config.calibration_file`, a camera.txt beside an .oni file, or the device,
/// in this order.
/// @throws std::runtime_error when the file cannot be read or is for images of another size, or the
///   device does not provide them
Intrinsics find_intrinsics(const SourceConfig& config, const OpenNi2Device& device);

}  // namespace kintsugi::mapper

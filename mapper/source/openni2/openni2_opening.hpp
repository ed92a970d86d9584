#pragma once
// What a user names, opened: a camera, a device of ours, or a file.

#include <memory>
#include <string>

#include "mapper/source/openni2/openni2_device.hpp"

namespace kintsugi::mapper {

/// A path to a file, in contrast to the URI of a device.
bool names_a_file(const std::string& device);

/// Opens the device that `config.device` names; a .oni file that is cut off as far as it goes, from
/// a mended copy in the folder for temporary files, which lasts only until it is open.
/// @param damage out: what is wrong with a .oni file, and how much of it is there; empty: nothing.
/// @throws std::runtime_error naming the device or file and what is wrong with it.
std::unique_ptr<OpenNi2Device> open_device(const SourceConfig& config, std::string& damage);

/// From the calibration file that is given, a camera.txt beside a .oni file, or the device.
/// @throws std::runtime_error when the file cannot be read or is for images of another size, or
/// nobody knows.
Intrinsics find_intrinsics(const SourceConfig& config, const OpenNi2Device& device);

}  // namespace kintsugi::mapper

#pragma once
// Selects the modes of the streams of an OpenNI2 device.

#include <string>
#include <vector>

#include <OpenNI.h>

#include "mapper/source/frames/device_mode.hpp"

namespace kintsugi::mapper {

/// The modes of a stream in pixel formats that the mapper reads, in the device's order.
std::vector<DeviceMode> usable_modes(const openni::SensorInfo& sensor);

DeviceMode mode_of(const openni::VideoStream& stream);

/// Sets the depth stream to mode `asked`; if empty, to the mode nearest to 640x480@30, or the only
/// mode of a recording. The unit is 0.1 mm where the device offers it and it reaches `max_range_m`,
/// else 1 mm.
/// @param asked as SourceConfig::depth_mode
/// @throws std::runtime_error naming the device and what it offers, when it does not offer `asked`,
///   refuses it, or gives depth in no unit that the mapper reads
void set_depth_mode(const openni::Device& device, openni::VideoStream& depth,
                    const std::string& asked, double max_range_m);

/// Sets the colour stream to mode `asked`; if empty, to the mode nearest to the size of the depth
/// image that covers the depth image.
/// @param asked as SourceConfig::color_mode
/// @return false when the stream does not cover the depth image
/// @throws std::runtime_error as above, and when mode `asked` does not cover the depth image
bool set_color_mode(const openni::Device& device, openni::VideoStream& color,
                    const std::string& asked, const DeviceMode& depth);

}  // namespace kintsugi::mapper

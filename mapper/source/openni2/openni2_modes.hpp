#pragma once
// What the streams of an OpenNI2 device offer, and what of it the mapper takes.

#include <string>
#include <vector>

#include <OpenNI.h>

#include "mapper/source/frames/device_mode.hpp"

namespace kintsugi::mapper {

/// The modes of a stream in pixel formats that the mapper reads, in the device's order.
std::vector<DeviceMode> usable_modes(const openni::SensorInfo& sensor);

DeviceMode mode_of(const openni::VideoStream& stream);

/// Sets the depth stream to the mode that is asked for; otherwise to 640x480@30 or the nearest to
/// it, a recording to its own. In units of 0.1 mm where the device has them and they reach
/// `max_range_m`, else in millimetres.
/// @param asked as SourceConfig::depth_mode
/// @throws std::runtime_error naming the device and what it offers, when it does not offer what is
/// asked for, refuses it, or gives depth in no unit that the mapper reads.
void set_depth_mode(const openni::Device& device, openni::VideoStream& depth,
                    const std::string& asked, double max_range_m);

/// Sets the colour stream to the mode that is asked for; otherwise to the depth image's size or the
/// nearest to it that covers the depth image.
/// @param asked as SourceConfig::color_mode
/// @return false when the stream does not cover the depth image.
/// @throws std::runtime_error as above, also when what is asked for does not cover the depth image.
bool set_color_mode(const openni::Device& device, openni::VideoStream& color,
                    const std::string& asked, const DeviceMode& depth);

}  // namespace kintsugi::mapper

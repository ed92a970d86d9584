#include "mapper/source/openni2/openni2_modes.hpp"

#include <algorithm>
#include <span>
#include <stdexcept>

#include "mapper/source/openni2/openni2_runtime.hpp"

namespace kintsugi::mapper {
namespace {

using Formats = std::vector<openni::PixelFormat>;

constexpr double kReachOf100um_m = 6.5534;
constexpr DeviceMode kUsual = {.width = 640, .height = 480, .rate_hz = 30};

/// Best first.
Formats depth_formats(double max_range_m) {
  Formats formats = {openni::PIXEL_FORMAT_DEPTH_1_MM, openni::PIXEL_FORMAT_DEPTH_100_UM};
  if (max_range_m <= kReachOf100um_m) std::ranges::reverse(formats);
  return formats;
}

const Formats& color_formats() {
  static const Formats formats = {openni::PIXEL_FORMAT_RGB888, openni::PIXEL_FORMAT_YUV422,
                                  openni::PIXEL_FORMAT_YUYV, openni::PIXEL_FORMAT_GRAY8};
  return formats;
}

DeviceMode device_mode(const openni::VideoMode& mode) {
  return {mode.getResolutionX(), mode.getResolutionY(), mode.getFps()};
}

/// Modes of a stream that suit, as OpenNI2 has them and as we do; the best format first.
struct Offer {
  std::vector<openni::VideoMode> video_modes;
  std::vector<DeviceMode> modes;
};

template <typename Suits>
Offer offer_of(const openni::SensorInfo& sensor, const Formats& formats, const Suits& suits) {
  Offer offer;
  const auto& all = sensor.getSupportedVideoModes();
  for (const openni::PixelFormat format : formats) {
    for (int i = 0; i < all.getSize(); ++i) {
      if (all[i].getPixelFormat() != format || !suits(device_mode(all[i]))) continue;
      offer.video_modes.push_back(all[i]);
      offer.modes.push_back(device_mode(all[i]));
    }
  }
  return offer;
}

std::string described(const openni::Device& device) {
  return std::string("device '") + device.getDeviceInfo().getUri() + "'";
}

/// @throws std::runtime_error when a mode is asked for and not offered or refused.
void set_mode(const openni::Device& device, openni::VideoStream& stream, const std::string& field,
              const std::string& asked, const DeviceMode& usual, const Offer& offer) {
  const auto index = asked.empty() ? nearest_mode(offer.modes, usual)
                                   : find_mode(offer.modes, DeviceMode::parse(field, asked));
  if (asked.empty() && !index) return;
  if (!index) {
    throw std::runtime_error(field + " is '" + asked + "', " + described(device) +
                             " offers: " + list_of(offer.modes));
  }
  const openni::VideoMode& mode = offer.video_modes[*index];
  // A .oni file lists the camera's modes and can play only its own: then this changes nothing.
  if (stream.setVideoMode(mode) == openni::STATUS_OK || asked.empty()) return;
  if (device_mode(stream.getVideoMode()) == device_mode(mode)) return;
  throw std::runtime_error(field + " is '" + asked + "', " + described(device) +
                           " offers it and refuses to change to it: " + openni2_error());
}

}  // namespace

std::vector<DeviceMode> usable_modes(const openni::SensorInfo& sensor) {
  Formats formats = depth_formats(0.0);
  formats.insert(formats.end(), color_formats().begin(), color_formats().end());
  return offer_of(sensor, formats, [](const DeviceMode&) { return true; }).modes;
}

DeviceMode mode_of(const openni::VideoStream& stream) { return device_mode(stream.getVideoMode()); }

void set_depth_mode(const openni::Device& device, openni::VideoStream& depth,
                    const std::string& asked, double max_range_m) {
  const Formats formats = depth_formats(max_range_m);
  const Offer offer =
      offer_of(depth.getSensorInfo(), formats, [](const DeviceMode&) { return true; });
  set_mode(device, depth, "depth_mode", asked, device.isFile() ? mode_of(depth) : kUsual, offer);
  const auto format = depth.getVideoMode().getPixelFormat();
  if (std::ranges::find(formats, format) != formats.end()) return;
  throw std::runtime_error(
      described(device) + " gives depth in pixel format " + std::to_string(format) +
      (format == openni::PIXEL_FORMAT_SHIFT_9_2 || format == openni::PIXEL_FORMAT_SHIFT_9_3
           ? " (raw disparities)"
           : "") +
      ", expected units of 1 mm or 0.1 mm; in those it offers: " + list_of(offer.modes));
}

bool set_color_mode(const openni::Device& device, openni::VideoStream& color,
                    const std::string& asked, const DeviceMode& depth) {
  const Offer offer = offer_of(color.getSensorInfo(), color_formats(), [&](const DeviceMode& mode) {
    return registered_part(mode.size(), depth.size()).has_value();
  });
  set_mode(device, color, "color_mode", asked, depth, offer);
  return registered_part(mode_of(color).size(), depth.size()).has_value();
}

}  // namespace kintsugi::mapper

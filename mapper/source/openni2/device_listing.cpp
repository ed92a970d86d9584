#include "mapper/source/openni2/device_listing.hpp"

#include <stdexcept>
#include <vector>

#include "mapper/source/openni2/openni2_modes.hpp"
#include "mapper/source/openni2/openni2_opening.hpp"
#include "mapper/source/openni2/openni2_runtime.hpp"

namespace kintsugi::mapper {
namespace {

std::string modes_text(openni::Device& device, openni::SensorType sensor) {
  if (!device.hasSensor(sensor)) return "none";
  return list_of(usable_modes(*device.getSensorInfo(sensor)));
}

std::string registration_text(openni::Device& device) {
  constexpr auto kRegistered = openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
  if (device.getImageRegistrationMode() == kRegistered) return "on";
  return device.isImageRegistrationModeSupported(kRegistered) ? "can be switched on" : "none";
}

std::string describe(const std::string& uri) {
  openni::Device device;
  if (device.open(uri.c_str()) != openni::STATUS_OK) {
    throw std::runtime_error("cannot open device '" + uri + "': " + openni2_error());
  }
  const openni::DeviceInfo& info = device.getDeviceInfo();
  std::string text = uri + "\n  " + info.getVendor() + " " + info.getName() + "\n";
  text += "  depth         " + modes_text(device, openni::SENSOR_DEPTH) + "\n";
  text += "  colour        " + modes_text(device, openni::SENSOR_COLOR) + "\n";
  text += "  registration  " + registration_text(device) + "\n";
  device.close();
  return text;
}

}  // namespace

std::string list_devices(const std::string& uri) {
  if (names_a_file(uri)) {
    throw std::runtime_error(uri + ": is a recording, which offers what it was recorded with");
  }
  const auto runtime = OpenNi2Runtime::shared();
  if (!uri.empty()) return describe(uri);
  std::string text;
  for (const openni::DeviceInfo& camera : plugged_in_cameras()) {
    try {
      text += describe(camera.getUri());
    } catch (const std::runtime_error& error) {
      text += std::string(camera.getUri()) + "\n  " + error.what() + "\n";
    }
  }
  return text.empty() ? "no camera is plugged in, or this user may not see it\n" : text;
}

}  // namespace kintsugi::mapper

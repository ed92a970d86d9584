#include "mapper/source/openni2/camera_return.hpp"

#include <algorithm>
#include <stdexcept>
#include <thread>

#include "mapper/source/openni2/openni2_runtime.hpp"

namespace kintsugi::mapper {
namespace {

constexpr std::chrono::milliseconds kMaxPause{2000};

std::string name_of(const openni::DeviceInfo& info) {
  return std::string(info.getVendor()) + " " + info.getName();
}

}  // namespace

CameraReturn::CameraReturn(const SourceConfig& config, const OpenNi2Device& camera)
    : config_(config),
      uri_(camera.uri()),
      name_(camera.name()),
      serial_number_(camera.serial_number()),
      image_size_(camera.image_size()) {}

std::unique_ptr<OpenNi2Device> CameraReturn::wait(std::chrono::milliseconds patience) {
  std::this_thread::sleep_until(std::min(next_attempt_, Clock::now() + patience));
  if (Clock::now() < next_attempt_) return nullptr;
  if (auto camera = open_any()) return camera;
  pause_ = std::min(2 * pause_, kMaxPause);
  next_attempt_ = Clock::now() + pause_;
  return nullptr;
}

double CameraReturn::seconds_away() const {
  return std::chrono::duration<double>(Clock::now() - gone_).count();
}

std::unique_ptr<OpenNi2Device> CameraReturn::open_any() {
  try {
    const auto runtime = OpenNi2Runtime::shared();  // searches for cameras
    for (const std::string& uri : addresses()) {
      try {
        return open(uri);
      } catch (const std::runtime_error& error) {
        last_error_ = error.what();
      }
    }
  } catch (const std::runtime_error& error) {
    last_error_ = error.what();
  }
  return nullptr;
}

/// @throws std::runtime_error when it cannot be opened or is another camera
std::unique_ptr<OpenNi2Device> CameraReturn::open(const std::string& uri) const {
  auto camera = std::make_unique<OpenNi2Device>(uri, config_);
  const std::string serial_number = camera->serial_number();
  if (!serial_number.empty() && !serial_number_.empty() && serial_number != serial_number_) {
    throw std::runtime_error("another camera is there: its serial number is " + serial_number +
                             ", expected " + serial_number_);
  }
  if (camera->image_size() != image_size_) {
    throw std::runtime_error("the camera is back with images of another size");
  }
  return camera;
}

/// Addresses to try: the previous one, unless cameras are listed and it is not among them; then
/// those of cameras with the same name.
std::vector<std::string> CameraReturn::addresses() const {
  std::vector<std::string> same_name;
  for (const openni::DeviceInfo& camera : plugged_in_cameras()) {
    if (uri_ == camera.getUri()) return {uri_};
    if (name_ == name_of(camera)) same_name.emplace_back(camera.getUri());
  }
  if (same_name.empty()) same_name.push_back(uri_);
  return same_name;
}

}  // namespace kintsugi::mapper

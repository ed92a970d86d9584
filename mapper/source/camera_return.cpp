#include "mapper/source/camera_return.hpp"

#include <algorithm>
#include <stdexcept>
#include <thread>

#include "mapper/source/openni2_runtime.hpp"

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
  try {
    return open();
  } catch (const std::runtime_error& error) {
    last_error_ = error.what();
  }
  pause_ = std::min(2 * pause_, kMaxPause);
  next_attempt_ = Clock::now() + pause_;
  return nullptr;
}

double CameraReturn::seconds_away() const {
  return std::chrono::duration<double>(Clock::now() - gone_).count();
}

std::unique_ptr<OpenNi2Device> CameraReturn::open() const {
  const auto runtime = OpenNi2Runtime::shared();
  auto camera = std::make_unique<OpenNi2Device>(find_address(), config_);
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

/// That of the camera as it is plugged in now; where none is listed, the one it had.
std::string CameraReturn::find_address() const {
  const auto cameras = plugged_in_cameras();
  const bool is_listed = std::ranges::any_of(
      cameras, [&](const openni::DeviceInfo& info) { return uri_ == info.getUri(); });
  if (is_listed) return uri_;
  const auto same_name = std::ranges::find(cameras, name_, name_of);
  return same_name == cameras.end() ? uri_ : same_name->getUri();
}

}  // namespace kintsugi::mapper

#include "mapper/source/openni2/openni2_runtime.hpp"

#include <mutex>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace kintsugi::mapper {

OpenNi2Runtime::OpenNi2Runtime() {
  if (openni::OpenNI::initialize() != openni::STATUS_OK) {
    throw std::runtime_error("OpenNI2 cannot be initialised: " + openni2_error());
  }
}

OpenNi2Runtime::~OpenNi2Runtime() { openni::OpenNI::shutdown(); }

std::shared_ptr<OpenNi2Runtime> OpenNi2Runtime::shared() {
  static std::mutex mutex;
  static std::weak_ptr<OpenNi2Runtime> current;
  const std::lock_guard lock(mutex);
  auto runtime = current.lock();
  if (!runtime) current = runtime = std::make_shared<OpenNi2Runtime>();
  return runtime;
}

std::string openni2_error() {
  std::istringstream words(openni::OpenNI::getExtendedError());
  std::string text;
  for (std::string word; words >> word;) text += (text.empty() ? "" : " ") + word;
  // What a driver says comes first, and OpenNI2 adds that the device could not be opened.
  const std::size_t added = text.find(" DeviceOpen: ");
  if (added != std::string::npos) text.erase(added);
  // No driver knows the name.
  if (text.starts_with("DeviceOpen: ")) {
    return "there is no file or folder of this name, and no such camera (--list-devices)";
  }
  return text.empty() ? "OpenNI2 gives no reason" : text;
}

std::vector<openni::DeviceInfo> plugged_in_cameras() {
  openni::Array<openni::DeviceInfo> listed;
  openni::OpenNI::enumerateDevices(&listed);
  std::vector<openni::DeviceInfo> cameras;
  cameras.reserve(static_cast<std::size_t>(listed.getSize()));
  for (int i = 0; i < listed.getSize(); ++i) cameras.push_back(listed[i]);
  return cameras;
}

DeviceListener::DeviceListener(std::string uri) : uri_(std::move(uri)) {
  openni::OpenNI::addDeviceStateChangedListener(this);
  openni::OpenNI::addDeviceDisconnectedListener(this);
}

DeviceListener::~DeviceListener() {
  openni::OpenNI::removeDeviceDisconnectedListener(this);
  openni::OpenNI::removeDeviceStateChangedListener(this);
}

void DeviceListener::onDeviceStateChanged(const openni::DeviceInfo* info,
                                          openni::DeviceState state) {
  if (info == nullptr || uri_ != info->getUri()) return;
  if (state == openni::DEVICE_STATE_EOF) state_ = DeviceState::kEnded;
  if (state == openni::DEVICE_STATE_ERROR) state_ = DeviceState::kFailed;
}

void DeviceListener::onDeviceDisconnected(const openni::DeviceInfo* info) {
  if (info != nullptr && uri_ == info->getUri()) state_ = DeviceState::kGone;
}

}  // namespace kintsugi::mapper

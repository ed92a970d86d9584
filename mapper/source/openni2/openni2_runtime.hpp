#pragma once
// The OpenNI2 library: initialisation, list of cameras, errors, device events.

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include <OpenNI.h>

#include "mapper/source/openni2/device_state.hpp"

namespace kintsugi::mapper {

/// Keeps OpenNI2 initialised. The library counts its users in the process: it loads its drivers and
/// searches for cameras with the first user, and unloads the drivers with the last.
class OpenNi2Runtime {
 public:
  /// @throws std::runtime_error with the message of OpenNI2
  OpenNi2Runtime();
  ~OpenNi2Runtime();
  OpenNi2Runtime(const OpenNi2Runtime&) = delete;
  OpenNi2Runtime& operator=(const OpenNi2Runtime&) = delete;

  /// The one of this process; it exists as long as somebody holds it.
  static std::shared_ptr<OpenNi2Runtime> shared();
};

/// OpenNI2's message about the last failure in this thread, on one line.
std::string openni2_error();

/// The connected cameras. Needs a runtime.
std::vector<openni::DeviceInfo> plugged_in_cameras();

/// Records the state of one device. Callbacks come from threads of the drivers.
class DeviceListener : public openni::OpenNI::DeviceStateChangedListener,
                       public openni::OpenNI::DeviceDisconnectedListener {
 public:
  explicit DeviceListener(std::string uri);
  ~DeviceListener() override;
  DeviceListener(const DeviceListener&) = delete;
  DeviceListener& operator=(const DeviceListener&) = delete;

  [[nodiscard]] DeviceState state() const { return state_; }

  void onDeviceStateChanged(const openni::DeviceInfo* info, openni::DeviceState state) override;
  void onDeviceDisconnected(const openni::DeviceInfo* info) override;

 private:
  const std::string uri_;
  std::atomic<DeviceState> state_ = DeviceState::kPlaying;
};

}  // namespace kintsugi::mapper

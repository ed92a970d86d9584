#pragma once
// OpenNI2's library as a whole: its life, its devices, what it says.

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include <OpenNI.h>

#include "mapper/source/openni2/device_state.hpp"

namespace kintsugi::mapper {

/// OpenNI2's library is one per process and counts its users; what the drivers load (threads, USB)
/// lives from the first user to the last, and cameras are looked for when that begins.
class OpenNi2Runtime {
 public:
  /// @throws std::runtime_error with what OpenNI2 says.
  OpenNi2Runtime();
  ~OpenNi2Runtime();
  OpenNi2Runtime(const OpenNi2Runtime&) = delete;
  OpenNi2Runtime& operator=(const OpenNi2Runtime&) = delete;

  /// The one of this process, for as long as somebody holds it.
  static std::shared_ptr<OpenNi2Runtime> shared();
};

/// What OpenNI2 has to say about the last failure in this thread, on one line.
std::string openni2_error();

/// The cameras that are plugged in. Needs a runtime.
std::vector<openni::DeviceInfo> plugged_in_cameras();

/// Listens, as long as it lives, for what happens to one device. Called from drivers' threads.
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

// The OpenNI2 driver plugin: `folder://PATH?key=value` and `synthetic://NAME?key=value`.
// OpenNI2 loads it as lib*.so.0 from OpenNI2/Drivers beside its own library.

#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "mapper/openni2_driver/plugin/camera_ports.hpp"
#include "mapper/openni2_driver/plugin/oni_driver_api.hpp"
#include "mapper/openni2_driver/plugin/recording_device.hpp"
#include "mapper/openni2_driver/recording/imitated_recording.hpp"
#include "mapper/openni2_driver/recording/recording_uri.hpp"

namespace kintsugi::mapper {
namespace {

OniDeviceInfo device_info(const std::string& uri, const std::string& name) {
  OniDeviceInfo info{};
  std::snprintf(info.uri, sizeof(info.uri), "%s", uri.c_str());
  std::snprintf(info.vendor, sizeof(info.vendor), "Kintsugi");
  std::snprintf(info.name, sizeof(info.name), "%s", name.c_str());
  return info;
}

class Driver : public oni::driver::DriverBase {
 public:
  explicit Driver(OniDriverServices* services) : DriverBase(services) {}

  /// Announces the imitated cameras that are plugged in.
  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback state_changed,
                       void* cookie) override {
    const OniStatus status = DriverBase::initialize(connected, disconnected, state_changed, cookie);
    for (const std::string& uri : camera_ports::listed()) tryDevice(uri.c_str());
    return status;
  }

  /// OpenNI2 asks every driver about an address it has not seen yet.
  OniStatus tryDevice(const char* uri) override {
    try {
      const auto parsed = parse_recording_uri(uri);
      if (!parsed) return ONI_STATUS_NO_DEVICE;
      if (std::string(uri).size() >= ONI_MAX_STR) {
        throw std::invalid_argument(std::string(uri) + ": longer than the 255 bytes of OpenNI2");
      }
      require_plugged_in(uri);
      const OniDeviceInfo info = device_info(uri, open_recording(*parsed)->name());
      deviceConnected(&info);
      return ONI_STATUS_OK;
    } catch (const std::exception& error) {
      report_error(error.what());
      return ONI_STATUS_NO_DEVICE;
    }
  }

  oni::driver::DeviceBase* deviceOpen(const char* uri, const char* /*mode*/) override {
    try {
      require_plugged_in(uri);
      const RecordingUri parsed = parse_recording_uri(uri).value();
      auto recording = open_recording(parsed);
      const OniDeviceInfo info = device_info(uri, recording->name());
      // What a camera does once in its life it does before it was away.
      const auto resume_utime = camera_ports::take_resume_utime(uri);
      CameraImitation imitation = parsed.imitation;
      if (resume_utime) imitation.unplug_at = 0;
      return new RecordingDevice(
          std::make_unique<ImitatedRecording>(std::move(recording), imitation, resume_utime),
          imitation,
          {.state_changed = [this,
                             info](OniDeviceState state) { deviceStateChanged(&info, state); },
           .report_error = [this](const std::string& text) { report_error(text); },
           .unplugged = [this, info,
                         imitation](std::int64_t utime) { unplug(info, imitation, utime); }});
    } catch (const std::exception& error) {
      report_error(error.what());
      return nullptr;
    }
  }

  void deviceClose(oni::driver::DeviceBase* device) override { delete device; }

  void shutdown() override {}

  /// Nothing to do: depth and colour carry the times they were recorded with. The group's handle
  /// must not be null.
  void* enableFrameSync(oni::driver::StreamBase** /*streams*/, int /*num_streams*/) override {
    return this;
  }

 private:
  static void require_plugged_in(const std::string& uri) {
    if (!camera_ports::is_plugged_in(uri)) throw std::runtime_error(uri + ": is not plugged in");
  }

  void unplug(const OniDeviceInfo& info, const CameraImitation& imitation, std::int64_t utime) {
    std::optional<std::chrono::microseconds> away;
    if (imitation.replug_after_us) away = std::chrono::microseconds(*imitation.replug_after_us);
    const std::string uri = info.uri;
    camera_ports::unplug(uri, utime, away, imitation.new_port ? uri + "&port=1" : uri);
    if (!imitation.unplug_silently) deviceDisconnected(&info);
  }

  void report_error(const std::string& text) {
    getServices().errorLoggerAppend("%s\n", text.c_str());
  }
};

}  // namespace
}  // namespace kintsugi::mapper

ONI_EXPORT_DRIVER(kintsugi::mapper::Driver)

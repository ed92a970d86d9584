#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "mapper/openni2_driver/plugin/oni_driver_api.hpp"
#include "mapper/openni2_driver/plugin/playback.hpp"
#include "mapper/openni2_driver/plugin/recording_stream.hpp"
#include "mapper/openni2_driver/recording/camera_imitation.hpp"
#include "mapper/openni2_driver/recording/device_properties.hpp"

namespace kintsugi::mapper {

/// A recording as an OpenNI2 device. For a client it is a file (isFile() is true): it has a
/// playback speed, repeats by default (like OpenNI2's own files), and knows its number of frames.
/// At the end the state of the device becomes EOF, or ERROR when no image could be read. Single
/// images that cannot be read are passed over and counted.
///
/// With an imitation it has the properties of that camera. CameraImitation::camera makes it a live
/// device, which starts again at the end of the recording.
class RecordingDevice : public oni::driver::DeviceBase {
 public:
  struct Callbacks {
    std::function<void(OniDeviceState)> state_changed;
    std::function<void(const std::string&)> report_error;  ///< for getExtendedError()
    /// The imitated camera is disconnected after the image of this time of the recording.
    std::function<void(std::int64_t utime)> unplugged;
  };

  RecordingDevice(std::unique_ptr<Recording> recording, const CameraImitation& imitation,
                  Callbacks callbacks);
  ~RecordingDevice() override = default;
  RecordingDevice(const RecordingDevice&) = delete;
  RecordingDevice& operator=(const RecordingDevice&) = delete;

  OniStatus getSensorInfoList(OniSensorInfo** infos, int* num_infos) override;
  oni::driver::StreamBase* createStream(OniSensorType type) override;
  void destroyStream(oni::driver::StreamBase* stream) override;
  OniStatus getProperty(int id, void* data, int* size) override;
  OniStatus setProperty(int id, const void* data, int size) override;
  OniBool isPropertySupported(int id) override;
  OniStatus invoke(int command, void* data, int size) override;
  OniBool isCommandSupported(int command) override;
  OniStatus tryManualTrigger() override;
  OniBool isImageRegistrationModeSupported(OniImageRegistrationMode mode) override;

 private:
  bool on_frame(const PlayedFrame& frame);
  void on_unread(StreamKind kind, const std::string& reason);
  void on_end(const std::string& error);
  void unplug(std::int64_t utime);
  OniStatus give_calibration(void* data, int* size);
  OniStatus give_playback_error(void* data, int* size);
  OniStatus give_unread_images(void* data, int* size);
  OniStatus set_registration(OniImageRegistrationMode mode);

  const std::unique_ptr<Recording> recording_;
  const CameraImitation imitation_;
  const Callbacks callbacks_;
  std::array<std::vector<OniVideoMode>, kNumStreamKinds> modes_;
  std::vector<OniSensorInfo> sensors_;
  std::atomic<bool> registered_;
  std::atomic<bool> unplugged_ = false;
  std::mutex mutex_;  ///< guards what follows
  std::array<RecordingStream*, kNumStreamKinds> streams_{};
  std::string playback_error_;
  UnreadImages unread_{};
  Playback playback_;  ///< last: its thread uses all of the above
};

}  // namespace kintsugi::mapper

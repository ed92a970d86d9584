#include "mapper/openni2_driver/plugin/recording_device.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "mapper/openni2_driver/device_properties.hpp"
#include "mapper/openni2_driver/plugin/property.hpp"

namespace kintsugi::mapper {
namespace {

constexpr OniVersion kDriverVersion = {.major = 0, .minor = 1, .maintenance = 0, .build = 0};

OniVideoMode video_mode(const Recording& recording, OniPixelFormat format) {
  return {.pixelFormat = format,
          .resolutionX = recording.intrinsics().width,
          .resolutionY = recording.intrinsics().height,
          .fps = recording.frame_rate_hz()};
}

DeviceCalibration device_calibration(const Intrinsics& intrinsics) {
  DeviceCalibration calibration{.fx = intrinsics.fx,
                                .fy = intrinsics.fy,
                                .cx = intrinsics.cx,
                                .cy = intrinsics.cy,
                                .distortion = {},
                                .width = intrinsics.width,
                                .height = intrinsics.height};
  std::ranges::copy(intrinsics.distortion, calibration.distortion);
  return calibration;
}

}  // namespace

RecordingDevice::RecordingDevice(std::unique_ptr<Recording> recording, Callbacks callbacks)
    : recording_(std::move(recording)),
      callbacks_(std::move(callbacks)),
      playback_(*recording_, {.frame = [this](const PlayedFrame& frame) { on_frame(frame); },
                              .end = [this](const std::string& error) { on_end(error); }}) {
  auto& [depth_modes, color_modes] = modes_;
  depth_modes.push_back(video_mode(*recording_, ONI_PIXEL_FORMAT_DEPTH_1_MM));
  if (recording_->finest_depth_unit() == DepthUnit::k100um) {
    depth_modes.push_back(video_mode(*recording_, ONI_PIXEL_FORMAT_DEPTH_100_UM));
  }
  sensors_.push_back({.sensorType = ONI_SENSOR_DEPTH,
                      .numSupportedVideoModes = static_cast<int>(depth_modes.size()),
                      .pSupportedVideoModes = depth_modes.data()});
  if (recording_->num_color_frames() == 0) return;
  color_modes.push_back(video_mode(*recording_, ONI_PIXEL_FORMAT_RGB888));
  sensors_.push_back({.sensorType = ONI_SENSOR_COLOR,
                      .numSupportedVideoModes = 1,
                      .pSupportedVideoModes = color_modes.data()});
}

OniStatus RecordingDevice::getSensorInfoList(OniSensorInfo** infos, int* num_infos) {
  *infos = sensors_.data();
  *num_infos = static_cast<int>(sensors_.size());
  return ONI_STATUS_OK;
}

oni::driver::StreamBase* RecordingDevice::createStream(OniSensorType type) {
  const bool offered = std::ranges::any_of(
      sensors_, [&](const OniSensorInfo& sensor) { return sensor.sensorType == type; });
  if (!offered) {
    callbacks_.report_error("this recording has no such stream");
    return nullptr;
  }
  const StreamKind kind = type == ONI_SENSOR_DEPTH ? StreamKind::kDepth : StreamKind::kColor;
  const auto slot = static_cast<std::size_t>(kind);
  auto stream = std::make_unique<RecordingStream>(kind, *recording_, playback_, modes_.at(slot));
  const std::lock_guard lock(mutex_);
  streams_.at(slot) = stream.get();
  return stream.release();  // OpenNI2 returns it through destroyStream()
}

void RecordingDevice::destroyStream(oni::driver::StreamBase* stream) {
  const std::unique_ptr<oni::driver::StreamBase> owned(stream);
  stream->stop();
  const std::lock_guard lock(mutex_);
  std::ranges::replace(streams_, static_cast<RecordingStream*>(stream), nullptr);
}

OniStatus RecordingDevice::getProperty(int id, void* data, int* size) {
  switch (id) {
    case ONI_DEVICE_PROPERTY_PLAYBACK_SPEED:
      return give_property(playback_.speed(), data, size);
    case ONI_DEVICE_PROPERTY_PLAYBACK_REPEAT_ENABLED:
      return give_property<OniBool>(playback_.repeat() ? TRUE : FALSE, data, size);
    case ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION:
      return give_property(ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR, data, size);
    case ONI_DEVICE_PROPERTY_DRIVER_VERSION:
      return give_property(kDriverVersion, data, size);
    case kDevicePropertyCalibration:
      return give_property(device_calibration(recording_->intrinsics()), data, size);
    case kDevicePropertyPlaybackError:
      return give_playback_error(data, size);
    default:
      return ONI_STATUS_NOT_SUPPORTED;
  }
}

OniStatus RecordingDevice::setProperty(int id, const void* data, int size) {
  if (id == ONI_DEVICE_PROPERTY_PLAYBACK_SPEED) {
    float speed = 0.0F;
    if (take_property(data, size, speed) != ONI_STATUS_OK || !std::isfinite(speed)) {
      return ONI_STATUS_BAD_PARAMETER;
    }
    playback_.set_speed(speed);
    return ONI_STATUS_OK;
  }
  if (id == ONI_DEVICE_PROPERTY_PLAYBACK_REPEAT_ENABLED) {
    OniBool repeat = FALSE;
    const OniStatus status = take_property(data, size, repeat);
    if (status == ONI_STATUS_OK) playback_.set_repeat(repeat != FALSE);
    return status;
  }
  if (id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) {
    OniImageRegistrationMode mode = ONI_IMAGE_REGISTRATION_OFF;
    const OniStatus status = take_property(data, size, mode);
    if (status != ONI_STATUS_OK) return status;
    return isImageRegistrationModeSupported(mode) != FALSE ? ONI_STATUS_OK
                                                           : ONI_STATUS_NOT_SUPPORTED;
  }
  return ONI_STATUS_NOT_SUPPORTED;
}

OniBool RecordingDevice::isPropertySupported(int id) {
  constexpr std::array kSupported = {ONI_DEVICE_PROPERTY_PLAYBACK_SPEED + 0,
                                     ONI_DEVICE_PROPERTY_PLAYBACK_REPEAT_ENABLED + 0,
                                     ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION + 0,
                                     ONI_DEVICE_PROPERTY_DRIVER_VERSION + 0,
                                     kDevicePropertyCalibration,
                                     kDevicePropertyPlaybackError};
  return std::ranges::find(kSupported, id) != kSupported.end() ? TRUE : FALSE;
}

OniStatus RecordingDevice::invoke(int /*command*/, void* /*data*/, int /*size*/) {
  // OpenNI2's core passes a pointer to an object that no longer exists to a seek.
  callbacks_.report_error("seeking is not supported: close the device and open it again");
  return ONI_STATUS_NOT_SUPPORTED;
}

OniBool RecordingDevice::isCommandSupported(int command) {
  // Device::isFile() asks for it: without it there would be no playback speed either.
  return command == ONI_DEVICE_COMMAND_SEEK ? TRUE : FALSE;
}

OniStatus RecordingDevice::tryManualTrigger() {
  playback_.trigger();
  return ONI_STATUS_OK;
}

OniBool RecordingDevice::isImageRegistrationModeSupported(OniImageRegistrationMode mode) {
  return mode == ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR ? TRUE : FALSE;
}

void RecordingDevice::on_frame(const PlayedFrame& frame) {
  RecordingStream* stream = nullptr;
  {
    const std::lock_guard lock(mutex_);
    stream = streams_.at(static_cast<std::size_t>(frame.kind));
  }
  if (stream != nullptr) stream->deliver(frame);  // alive: its stop() waits for this
}

void RecordingDevice::on_end(const std::string& error) {
  {
    const std::lock_guard lock(mutex_);
    playback_error_ = error;
  }
  callbacks_.state_changed(error.empty() ? ONI_DEVICE_STATE_EOF : ONI_DEVICE_STATE_ERROR);
}

OniStatus RecordingDevice::give_playback_error(void* data, int* size) {
  if (data == nullptr || *size < 1) return ONI_STATUS_BAD_PARAMETER;
  const std::lock_guard lock(mutex_);
  const std::size_t length = std::min(playback_error_.size(), static_cast<std::size_t>(*size) - 1);
  std::memcpy(data, playback_error_.data(), length);
  static_cast<char*>(data)[length] = '\0';
  *size = static_cast<int>(length) + 1;
  return ONI_STATUS_OK;
}

}  // namespace kintsugi::mapper

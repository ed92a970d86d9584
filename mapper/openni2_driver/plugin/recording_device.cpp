#include "mapper/openni2_driver/plugin/recording_device.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mapper/openni2_driver/plugin/imitated_image.hpp"
#include "mapper/openni2_driver/plugin/offered_modes.hpp"
#include "mapper/openni2_driver/plugin/property.hpp"

namespace kintsugi::mapper {
namespace {

constexpr OniVersion kDriverVersion = {.major = 0, .minor = 1, .maintenance = 0, .build = 0};

/// @param size of the images that leave the device, which may be scaled.
DeviceCalibration device_calibration(const Intrinsics& intrinsics, cv::Size size) {
  const double x_scale = static_cast<double>(size.width) / intrinsics.width;
  const double y_scale = static_cast<double>(size.height) / intrinsics.height;
  DeviceCalibration calibration{.fx = x_scale * intrinsics.fx,
                                .fy = y_scale * intrinsics.fy,
                                .cx = x_scale * (intrinsics.cx + 0.5) - 0.5,
                                .cy = y_scale * (intrinsics.cy + 0.5) - 0.5,
                                .distortion = {},
                                .width = size.width,
                                .height = size.height};
  std::ranges::copy(intrinsics.distortion, calibration.distortion);
  return calibration;
}

}  // namespace

RecordingDevice::RecordingDevice(std::unique_ptr<Recording> recording,
                                 const CameraImitation& imitation, Callbacks callbacks)
    : recording_(std::move(recording)),
      imitation_(imitation),
      callbacks_(std::move(callbacks)),
      modes_{offered_depth_modes(*recording_, imitation),
             offered_color_modes(*recording_, imitation)},
      registered_(imitation.registration == CameraImitation::Registration::kAligned),
      playback_(*recording_,
                {.frame = [this](const PlayedFrame& frame) { return on_frame(frame); },
                 .unread = [this](StreamKind kind,
                                  const std::string& reason) { on_unread(kind, reason); },
                 .end = [this](const std::string& error) { on_end(error); }}) {
  constexpr std::array kTypes = {ONI_SENSOR_DEPTH, ONI_SENSOR_COLOR};  // by StreamKind
  for (std::size_t i = 0; i < kNumStreamKinds; ++i) {
    if (modes_.at(i).empty()) continue;
    sensors_.push_back({.sensorType = kTypes.at(i),
                        .numSupportedVideoModes = static_cast<int>(modes_.at(i).size()),
                        .pSupportedVideoModes = modes_.at(i).data()});
  }
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
  auto stream =
      std::make_unique<RecordingStream>(kind, *recording_, imitation_, playback_, modes_.at(slot));
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
      return give_property(
          registered_ ? ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR : ONI_IMAGE_REGISTRATION_OFF, data,
          size);
    case ONI_DEVICE_PROPERTY_DRIVER_VERSION:
      return give_property(kDriverVersion, data, size);
    case ONI_DEVICE_PROPERTY_SERIAL_NUMBER:
      return give_text(imitation_.serial_number, data, size);
    case kDevicePropertyCalibration:
      return give_calibration(data, size);
    case kDevicePropertyPlaybackError:
      return give_playback_error(data, size);
    case kDevicePropertyUnreadImages:
      return give_unread_images(data, size);
    case kDevicePropertyRemark:
      return give_text(recording_->remark(), data, size);
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
    return status == ONI_STATUS_OK ? set_registration(mode) : status;
  }
  return ONI_STATUS_NOT_SUPPORTED;
}

OniBool RecordingDevice::isPropertySupported(int id) {
  switch (id) {
    case ONI_DEVICE_PROPERTY_PLAYBACK_SPEED:
    case ONI_DEVICE_PROPERTY_PLAYBACK_REPEAT_ENABLED:
      return imitation_.camera ? FALSE : TRUE;
    case ONI_DEVICE_PROPERTY_SERIAL_NUMBER:
      return imitation_.serial_number.empty() ? FALSE : TRUE;
    case kDevicePropertyCalibration:
      return imitation_.calibration ? TRUE : FALSE;
    case ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION:
    case ONI_DEVICE_PROPERTY_DRIVER_VERSION:
    case kDevicePropertyPlaybackError:
    case kDevicePropertyUnreadImages:
    case kDevicePropertyRemark:
      return TRUE;
    default:
      return FALSE;
  }
}

OniStatus RecordingDevice::invoke(int /*command*/, void* /*data*/, int /*size*/) {
  // OpenNI2's core passes a pointer to an object that no longer exists to a seek.
  callbacks_.report_error("seeking is not supported: close the device and open it again");
  return ONI_STATUS_NOT_SUPPORTED;
}

OniBool RecordingDevice::isCommandSupported(int command) {
  // Device::isFile() asks for it: without it there would be no playback speed either.
  return command == ONI_DEVICE_COMMAND_SEEK && !imitation_.camera ? TRUE : FALSE;
}

OniStatus RecordingDevice::tryManualTrigger() {
  playback_.trigger();
  return ONI_STATUS_OK;
}

OniBool RecordingDevice::isImageRegistrationModeSupported(OniImageRegistrationMode mode) {
  using enum CameraImitation::Registration;
  if (mode == ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR) {
    return imitation_.registration == kOff ? FALSE : TRUE;
  }
  return imitation_.registration == kAligned ? FALSE : TRUE;
}

OniStatus RecordingDevice::set_registration(OniImageRegistrationMode mode) {
  if (isImageRegistrationModeSupported(mode) == FALSE) return ONI_STATUS_NOT_SUPPORTED;
  registered_ = mode == ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR;
  return ONI_STATUS_OK;
}

/// Whether anything came of it.
bool RecordingDevice::on_frame(const PlayedFrame& frame) {
  if (unplugged_) return true;
  const bool is_depth = frame.kind == StreamKind::kDepth;
  if (is_depth && imitation_.unplug_at > 0 && frame.number > imitation_.unplug_at) {
    unplug(frame.due_utime);
    return true;
  }
  RecordingStream* stream = nullptr;
  {
    const std::lock_guard lock(mutex_);
    stream = streams_.at(static_cast<std::size_t>(frame.kind));
  }
  if (stream == nullptr) return false;
  // The stream is alive: its stop() waits for this.
  if (!is_depth || registered_) return stream->deliver(frame);
  PlayedFrame beside = frame;
  beside.image = unregistered(frame.image);
  return stream->deliver(beside);
}

void RecordingDevice::unplug(std::int64_t utime) {
  unplugged_ = true;
  playback_.halt();
  callbacks_.unplugged(utime);
}

void RecordingDevice::on_unread(StreamKind kind, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  ++(kind == StreamKind::kDepth ? unread_.depth : unread_.color);
  int size = sizeof(unread_.last_reason);
  give_text(reason, unread_.last_reason, &size);
}

void RecordingDevice::on_end(const std::string& error) {
  {
    const std::lock_guard lock(mutex_);
    playback_error_ = error;
  }
  callbacks_.state_changed(error.empty() ? ONI_DEVICE_STATE_EOF : ONI_DEVICE_STATE_ERROR);
}

OniStatus RecordingDevice::give_calibration(void* data, int* size) {
  const Intrinsics& intrinsics = recording_->intrinsics();
  cv::Size images(intrinsics.width, intrinsics.height);
  const std::lock_guard lock(mutex_);
  if (RecordingStream* depth = streams_.front()) images = depth->image_size();
  return give_property(device_calibration(intrinsics, images), data, size);
}

OniStatus RecordingDevice::give_unread_images(void* data, int* size) {
  const std::lock_guard lock(mutex_);
  return give_property(unread_, data, size);
}

OniStatus RecordingDevice::give_playback_error(void* data, int* size) {
  const std::lock_guard lock(mutex_);
  return give_text(playback_error_, data, size);
}

}  // namespace kintsugi::mapper

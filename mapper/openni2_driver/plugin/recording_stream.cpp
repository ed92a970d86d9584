#include "mapper/openni2_driver/plugin/recording_stream.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include <opencv2/core.hpp>

#include "mapper/openni2_driver/plugin/imitated_image.hpp"
#include "mapper/openni2_driver/plugin/property.hpp"

namespace kintsugi::mapper {
namespace {

bool same_mode(const OniVideoMode& a, const OniVideoMode& b) {
  return a.pixelFormat == b.pixelFormat && a.resolutionX == b.resolutionX &&
         a.resolutionY == b.resolutionY && a.fps == b.fps;
}

OniCropping whole_image(const OniVideoMode& mode) {
  return {.enabled = FALSE,
          .originX = 0,
          .originY = 0,
          .width = mode.resolutionX,
          .height = mode.resolutionY};
}

}  // namespace

RecordingStream::RecordingStream(StreamKind kind, const Recording& recording,
                                 const CameraImitation& imitation, Playback& playback,
                                 std::vector<OniVideoMode> modes)
    : kind_(kind),
      recording_(recording),
      imitation_(imitation),
      playback_(playback),
      modes_(std::move(modes)),
      mode_(modes_.front()),
      cropping_(whole_image(mode_)),
      mirrored_(imitation.mirror != CameraImitation::Mirroring::kOff) {
  if (kind_ == StreamKind::kDepth) playback_.set_depth_unit(depth_unit());
}

RecordingStream::~RecordingStream() { playback_.stop(kind_); }

OniStatus RecordingStream::start() {
  {
    const std::lock_guard lock(mutex_);
    started_ = true;
    rate_filter_.restart();
  }
  playback_.start(kind_);
  return ONI_STATUS_OK;
}

void RecordingStream::stop() {
  playback_.stop(kind_);
  const std::lock_guard lock(mutex_);
  started_ = false;
}

OniStatus RecordingStream::getProperty(int id, void* data, int* size) {
  const std::lock_guard lock(mutex_);
  if (isPropertySupported(id) == FALSE) return ONI_STATUS_NOT_SUPPORTED;
  if (CameraControls::has(id)) return controls_.get(id, data, size);
  const Intrinsics& camera = recording_.intrinsics();
  switch (id) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE:
      return give_property(mode_, data, size);
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
      return give_property(field_of_view_rad(camera.width, camera.fx), data, size);
    case ONI_STREAM_PROPERTY_VERTICAL_FOV:
      return give_property(field_of_view_rad(camera.height, std::abs(camera.fy)), data, size);
    case ONI_STREAM_PROPERTY_NUMBER_OF_FRAMES:
      return give_property(kind_ == StreamKind::kDepth ? recording_.num_depth_frames()
                                                       : recording_.num_color_frames(),
                           data, size);
    case ONI_STREAM_PROPERTY_CROPPING:
      return give_property(cropping_, data, size);
    case ONI_STREAM_PROPERTY_MIRRORING:
      return give_property<OniBool>(mirrored_ ? TRUE : FALSE, data, size);
    case ONI_STREAM_PROPERTY_STRIDE:  // of a whole line, also while cropping is on
      return give_property(mode_.resolutionX * bytes_per_pixel(), data, size);
    case ONI_STREAM_PROPERTY_MIN_VALUE:
      return give_property<int>(0, data, size);
    case ONI_STREAM_PROPERTY_MAX_VALUE:
      return give_property<int>(max_depth_value(depth_unit()), data, size);
    default:
      return ONI_STATUS_NOT_SUPPORTED;
  }
}

OniStatus RecordingStream::setProperty(int id, const void* data, int size) {
  const std::lock_guard lock(mutex_);
  OniVideoMode mode;
  OniCropping cropping;
  OniBool mirrored = FALSE;
  OniStatus status = ONI_STATUS_NOT_SUPPORTED;
  if (isPropertySupported(id) == FALSE) return status;
  if (CameraControls::has(id)) return controls_.set(id, data, size);
  switch (id) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE:
      status = take_property(data, size, mode);
      return status == ONI_STATUS_OK ? set_mode(mode) : status;
    case ONI_STREAM_PROPERTY_CROPPING:
      status = take_property(data, size, cropping);
      return status == ONI_STATUS_OK ? set_cropping(cropping) : status;
    case ONI_STREAM_PROPERTY_MIRRORING:
      status = take_property(data, size, mirrored);
      return status == ONI_STATUS_OK ? set_mirroring(mirrored != FALSE) : status;
    default:
      return status;
  }
}

OniBool RecordingStream::isPropertySupported(int id) {
  if (CameraControls::has(id)) {
    return imitation_.exposure && kind_ == StreamKind::kColor ? TRUE : FALSE;
  }
  switch (id) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE:
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
    case ONI_STREAM_PROPERTY_VERTICAL_FOV:
    case ONI_STREAM_PROPERTY_NUMBER_OF_FRAMES:
    case ONI_STREAM_PROPERTY_CROPPING:
    case ONI_STREAM_PROPERTY_MIRRORING:
    case ONI_STREAM_PROPERTY_STRIDE:
      return TRUE;
    case ONI_STREAM_PROPERTY_MIN_VALUE:
    case ONI_STREAM_PROPERTY_MAX_VALUE:
      return kind_ == StreamKind::kDepth ? TRUE : FALSE;
    default:
      return FALSE;
  }
}

void RecordingStream::notifyAllProperties() {
  for (const int id :
       {ONI_STREAM_PROPERTY_VIDEO_MODE, ONI_STREAM_PROPERTY_HORIZONTAL_FOV,
        ONI_STREAM_PROPERTY_VERTICAL_FOV, ONI_STREAM_PROPERTY_CROPPING,
        ONI_STREAM_PROPERTY_MIRRORING, ONI_STREAM_PROPERTY_STRIDE, ONI_STREAM_PROPERTY_MAX_VALUE}) {
    std::array<std::byte, 64> value{};
    int size = static_cast<int>(value.size());
    if (getProperty(id, value.data(), &size) == ONI_STATUS_OK) {
      raisePropertyChanged(id, value.data(), size);
    }
  }
}

OniStatus RecordingStream::convertDepthToColorCoordinates(StreamBase* /*color*/, int depth_x,
                                                          int depth_y, OniDepthPixel /*depth*/,
                                                          int* color_x, int* color_y) {
  *color_x = depth_x;
  *color_y = depth_y;
  return ONI_STATUS_OK;
}

bool RecordingStream::deliver(const PlayedFrame& played) {
  {
    const std::lock_guard lock(mutex_);
    if (!rate_filter_.passes(played.due_utime, mode_.fps, recording_.frame_rate_hz())) return false;
  }
  OniFrame* frame = getServices().acquireFrame();
  if (frame == nullptr) return true;
  {
    const std::lock_guard lock(mutex_);
    const cv::Mat image = finish(played);
    frame->sensorType = kind_ == StreamKind::kDepth ? ONI_SENSOR_DEPTH : ONI_SENSOR_COLOR;
    frame->timestamp = static_cast<std::uint64_t>(played.utime);
    frame->frameIndex = played.number - rate_filter_.num_left_out();
    frame->videoMode = mode_;
    frame->width = image.cols;
    frame->height = image.rows;
    frame->croppingEnabled = cropping_.enabled;
    frame->cropOriginX = cropping_.enabled != FALSE ? cropping_.originX : 0;
    frame->cropOriginY = cropping_.enabled != FALSE ? cropping_.originY : 0;
    frame->stride = image.cols * bytes_per_pixel();
    frame->dataSize = frame->stride * image.rows;
    cv::Mat target(image.rows, image.cols, image.type(), frame->data,
                   static_cast<std::size_t>(frame->stride));
    image.copyTo(target);
    if (kind_ == StreamKind::kDepth) spoil(*frame, played.number, imitation_);
  }
  raiseNewFrame(frame);
  getServices().releaseFrame(frame);
  return true;
}

cv::Size RecordingStream::image_size() {
  const std::lock_guard lock(mutex_);
  return {mode_.resolutionX, mode_.resolutionY};
}

/// The image as the settings of the stream make it.
cv::Mat RecordingStream::finish(const PlayedFrame& frame) {
  cv::Mat image = image_in_mode(frame.image, {mode_.resolutionX, mode_.resolutionY});
  if (isPropertySupported(ONI_STREAM_PROPERTY_EXPOSURE) != FALSE) {
    image = controls_.expose(image, frame.due_utime);
  }
  if (mirrored_) {
    cv::Mat mirrored;
    cv::flip(image, mirrored, 1);
    image = mirrored;
  }
  if (cropping_.enabled == FALSE) return image;
  return image(cv::Rect(cropping_.originX, cropping_.originY, cropping_.width, cropping_.height));
}

OniStatus RecordingStream::set_mirroring(bool mirrored) {
  if (imitation_.mirror == CameraImitation::Mirroring::kStuck && !mirrored) {
    return ONI_STATUS_NOT_SUPPORTED;
  }
  mirrored_ = mirrored;
  return ONI_STATUS_OK;
}

OniStatus RecordingStream::set_mode(const OniVideoMode& mode) {
  const bool offered = std::ranges::any_of(
      modes_, [&](const OniVideoMode& offer) { return same_mode(offer, mode); });
  if (!offered || imitation_.refuse_modes) return ONI_STATUS_NOT_SUPPORTED;
  if (same_mode(mode, mode_)) return ONI_STATUS_OK;
  if (started_) return ONI_STATUS_OUT_OF_FLOW;
  mode_ = mode;
  cropping_ = whole_image(mode_);
  if (kind_ == StreamKind::kDepth) playback_.set_depth_unit(depth_unit());
  return ONI_STATUS_OK;
}

OniStatus RecordingStream::set_cropping(const OniCropping& cropping) {
  if (cropping.enabled == FALSE) {
    cropping_ = whole_image(mode_);
    return ONI_STATUS_OK;
  }
  const bool inside = cropping.originX >= 0 && cropping.originY >= 0 && cropping.width > 0 &&
                      cropping.height > 0 &&
                      cropping.width <= mode_.resolutionX - cropping.originX &&
                      cropping.height <= mode_.resolutionY - cropping.originY;
  if (!inside) return ONI_STATUS_BAD_PARAMETER;
  cropping_ = cropping;
  return ONI_STATUS_OK;
}

DepthUnit RecordingStream::depth_unit() const {
  return mode_.pixelFormat == ONI_PIXEL_FORMAT_DEPTH_100_UM ? DepthUnit::k100um : DepthUnit::k1mm;
}

int RecordingStream::bytes_per_pixel() const { return kind_ == StreamKind::kDepth ? 2 : 3; }

float RecordingStream::field_of_view_rad(int pixels, double focal_length) const {
  return static_cast<float>(2.0 * std::atan(0.5 * pixels / focal_length));
}

}  // namespace kintsugi::mapper

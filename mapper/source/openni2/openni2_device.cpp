#include "mapper/source/openni2/openni2_device.hpp"

#include <algorithm>
#include <array>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include <OpenNI.h>

#include "mapper/source/openni2/openni2_image.hpp"
#include "mapper/source/openni2/openni2_intrinsics.hpp"
#include "mapper/source/openni2/openni2_modes.hpp"
#include "mapper/source/openni2/openni2_runtime.hpp"

namespace kintsugi::mapper {
namespace {

std::string first_camera() {
  const auto cameras = plugged_in_cameras();
  if (cameras.empty()) {
    throw std::runtime_error(
        "no camera found: OpenNI2 lists no device (is it plugged in, and may this user open it?)");
  }
  return cameras.front().getUri();
}

}  // namespace

struct OpenNi2Device::Implementation {
  Implementation(const std::string& wanted_uri, const SourceConfig& source_config)
      : config(source_config),
        uri(wanted_uri.empty() ? first_camera() : wanted_uri),
        listener(uri) {
    if (device.open(uri.c_str()) != openni::STATUS_OK) {
      throw std::runtime_error("cannot open device '" + uri + "': " + openni2_error());
    }
    create(depth, openni::SENSOR_DEPTH, "depth");
    set_depth_mode(device, depth, config.depth_mode, config.max_range_m);
    if (device.hasSensor(openni::SENSOR_COLOR)) uses_color = create_color();
    if (openni::PlaybackControl* playback = device.getPlaybackControl()) {
      playback->setRepeatEnabled(false);
      playback->setSpeed(-1.0F);  // as fast as it is read
    }
    start(depth, "depth");
    if (uses_color) start(color, "colour");
  }

  ~Implementation() {
    stop();
    depth.destroy();
    color.destroy();
    device.close();
  }

  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  void create(openni::VideoStream& stream, openni::SensorType sensor, const char* what) {
    if (!device.hasSensor(sensor)) {
      throw std::runtime_error("device '" + uri + "' has no " + what + " stream");
    }
    if (stream.create(device, sensor) != openni::STATUS_OK) fail(what, "created");
  }

  /// False when the stream's images do not lie on the depth images' pixels: then it stays there,
  /// not started, for destroying a stream of a .oni file may crash (see ~OpenNi2Device()).
  bool create_color() {
    create(color, openni::SENSOR_COLOR, "colour");
    if (!set_color_mode(device, color, config.color_mode, mode_of(depth))) {
      say_without_color("is " + to_string(mode_of(color)) + ", which does not cover depth of " +
                        to_string(mode_of(depth)));
      return false;
    }
    if (is_registered() || config.assume_registered) return true;
    say_without_color(
        "is not aligned with depth: the device cannot do it, and does not say that it is "
        "(--assume-registered takes it as it is)");
    return false;
  }

  /// Switches registration on where the device can.
  bool is_registered() {
    constexpr auto kRegistered = openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
    if (device.isImageRegistrationModeSupported(kRegistered)) {
      device.setImageRegistrationMode(kRegistered);
    }
    return device.getImageRegistrationMode() == kRegistered;
  }

  void say_without_color(const std::string& why) const {
    config.notify({SourceNotice::Kind::kWarning,
                   "device '" + uri + "': depth alone, colour is not used: it " + why});
  }

  void start(openni::VideoStream& stream, const char* what) {
    stream.setMirroringEnabled(false);  // what cannot is un-mirrored when it is read
    if (stream.isCroppingSupported()) stream.resetCropping();
    if (stream.start() != openni::STATUS_OK) fail(what, "started");
  }

  void stop() {
    depth.stop();
    color.stop();
  }

  /// A .oni file, played by OpenNI2's own driver.
  [[nodiscard]] bool is_oni_file() const {
    return device.isFile() && !device.isPropertySupported(kDevicePropertyPlaybackError);
  }

  /// A text property of our own devices; empty for others.
  [[nodiscard]] std::string own_text(int property) const {
    std::array<char, 1024> text{};
    int size = static_cast<int>(text.size());
    if (device.isPropertySupported(property)) device.getProperty(property, text.data(), &size);
    return text.data();
  }

  [[noreturn]] void fail(const char* what, const char* done) const {
    throw std::runtime_error("the " + std::string(what) + " stream of device '" + uri +
                             "' cannot be " + done + ": " + openni2_error());
  }

  const SourceConfig config;
  // Before everything of OpenNI2's: outlives all of the below.
  const std::shared_ptr<OpenNi2Runtime> runtime = OpenNi2Runtime::shared();
  const std::string uri;
  DeviceListener listener;
  openni::Device device;
  openni::VideoStream depth;
  openni::VideoStream color;
  bool uses_color = false;
};

OpenNi2Device::OpenNi2Device(const std::string& uri, const SourceConfig& config)
    : implementation_(std::make_unique<Implementation>(uri, config)) {}

OpenNi2Device::~OpenNi2Device() {
  implementation_->stop();
  if (!implementation_->is_oni_file()) return;
  // OpenNI2's file driver walks its list of streams, without a lock, in the thread that plays,
  // while a stream that is destroyed takes itself out of it: 1 in 8 runs crashed. Stopped, the
  // thread sleeps and touches nothing that goes away before the process does; so it is left that
  // way.
  using Devices = std::vector<std::unique_ptr<Implementation>>;
  static Devices& left_stopped = *std::make_unique<Devices>().release();  // never destroyed
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  left_stopped.push_back(std::move(implementation_));
}

void OpenNi2Device::stop() { implementation_->stop(); }

std::optional<DeviceImage> OpenNi2Device::wait(std::chrono::milliseconds timeout) {
  Implementation& impl = *implementation_;
  std::array<openni::VideoStream*, 2> streams = {&impl.depth, &impl.color};
  int ready = -1;
  const auto status = openni::OpenNI::waitForAnyStream(streams.data(), has_color() ? 2 : 1, &ready,
                                                       static_cast<int>(timeout.count()));
  if (status == openni::STATUS_TIME_OUT) return std::nullopt;
  openni::VideoFrameRef frame;
  if (status != openni::STATUS_OK ||
      streams.at(static_cast<std::size_t>(ready))->readFrame(&frame) != openni::STATUS_OK) {
    throw std::runtime_error("device '" + impl.uri + "': " + openni2_error());
  }
  if (!frame.isValid()) return std::nullopt;

  DeviceImage image{.is_depth = ready == 0,
                    .utime = static_cast<std::int64_t>(frame.getTimestamp()),
                    .index = frame.getFrameIndex(),
                    .depth_raw = {},
                    .color_rgb = {}};
  const bool mirrored = streams.at(static_cast<std::size_t>(ready))->getMirroringEnabled();
  if (image.is_depth) {
    image.depth_raw = copy_depth(frame, mirrored);
  } else {
    image.color_rgb = copy_color(frame, mirrored, image_size());
  }
  return image;
}

bool OpenNi2Device::lock_exposure() {
  openni::CameraSettings* settings =
      has_color() ? implementation_->color.getCameraSettings() : nullptr;
  if (settings == nullptr) return false;
  const bool exposure = settings->setAutoExposureEnabled(false) == openni::STATUS_OK;
  const bool white_balance = settings->setAutoWhiteBalanceEnabled(false) == openni::STATUS_OK;
  return exposure && white_balance;
}

DeviceState OpenNi2Device::state() const { return implementation_->listener.state(); }

std::string OpenNi2Device::failure() const {
  const std::string reason = implementation_->own_text(kDevicePropertyPlaybackError);
  return reason.empty() ? "the device reports a fault" : reason;
}

UnreadImages OpenNi2Device::unread_images() const {
  const openni::Device& device = implementation_->device;
  UnreadImages images{};
  int size = sizeof(images);
  if (device.isPropertySupported(kDevicePropertyUnreadImages)) {
    device.getProperty(kDevicePropertyUnreadImages, &images, &size);
  }
  return images;
}

std::string OpenNi2Device::remark() const {
  return implementation_->own_text(kDevicePropertyRemark);
}

std::string OpenNi2Device::name() const {
  const openni::DeviceInfo& info = implementation_->device.getDeviceInfo();
  return std::string(info.getVendor()) + " " + info.getName();
}

std::string OpenNi2Device::uri() const { return implementation_->uri; }

std::string OpenNi2Device::serial_number() const {
  const openni::Device& device = implementation_->device;
  std::array<char, 256> text{};
  int size = static_cast<int>(text.size()) - 1;  // and a zero in any case
  const bool told = device.isPropertySupported(openni::DEVICE_PROPERTY_SERIAL_NUMBER) &&
                    device.getProperty(openni::DEVICE_PROPERTY_SERIAL_NUMBER, text.data(), &size) ==
                        openni::STATUS_OK;
  return told ? text.data() : "";
}

bool OpenNi2Device::is_recording() const { return implementation_->device.isFile(); }

bool OpenNi2Device::has_color() const { return implementation_->uses_color; }

std::optional<int> OpenNi2Device::num_depth_frames() const {
  openni::PlaybackControl* playback = implementation_->device.getPlaybackControl();
  if (playback == nullptr) return std::nullopt;
  return playback->getNumberOfFrames(implementation_->depth);
}

double OpenNi2Device::depth_units_per_m() const {
  const auto format = implementation_->depth.getVideoMode().getPixelFormat();
  return format == openni::PIXEL_FORMAT_DEPTH_100_UM ? 10000.0 : 1000.0;
}

int OpenNi2Device::depth_rate_hz() const {
  return std::max(1, implementation_->depth.getVideoMode().getFps());
}

cv::Size OpenNi2Device::image_size() const { return mode_of(implementation_->depth).size(); }

Intrinsics OpenNi2Device::intrinsics() const {
  const Implementation& impl = *implementation_;
  return intrinsics_of(impl.device, impl.depth, impl.uses_color ? &impl.color : nullptr);
}

}  // namespace kintsugi::mapper

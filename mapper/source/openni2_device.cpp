#include "mapper/source/openni2_device.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include <OpenNI.h>

#include "mapper/openni2_driver/device_properties.hpp"
#include "mapper/source/openni2_image.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kReachOf100um_m = 6.5534;

std::string trimmed_error() {
  std::string text = openni::OpenNI::getExtendedError();
  std::ranges::replace(text, '\n', ' ');
  text.erase(text.find_last_not_of(" \t\r") + 1);
  return text.empty() ? "OpenNI2 gives no reason" : text;
}

/// OpenNI2's library is one per process and counts its users; what the drivers load (threads, USB)
/// lives from the first user to the last.
class Runtime {
 public:
  Runtime() {
    if (openni::OpenNI::initialize() != openni::STATUS_OK) {
      throw std::runtime_error("OpenNI2 cannot be initialised: " + trimmed_error());
    }
  }
  ~Runtime() { openni::OpenNI::shutdown(); }
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;
};

/// Listens, as long as it lives, for what happens to one device. Called from drivers' threads.
class StateListener : public openni::OpenNI::DeviceStateChangedListener,
                      public openni::OpenNI::DeviceDisconnectedListener {
 public:
  explicit StateListener(std::string uri) : uri_(std::move(uri)) {
    openni::OpenNI::addDeviceStateChangedListener(this);
    openni::OpenNI::addDeviceDisconnectedListener(this);
  }
  ~StateListener() override {
    openni::OpenNI::removeDeviceDisconnectedListener(this);
    openni::OpenNI::removeDeviceStateChangedListener(this);
  }
  StateListener(const StateListener&) = delete;
  StateListener& operator=(const StateListener&) = delete;

  [[nodiscard]] OpenNi2Device::State state() const { return state_; }

  void onDeviceStateChanged(const openni::DeviceInfo* info, openni::DeviceState state) override {
    if (info == nullptr || uri_ != info->getUri()) return;
    if (state == openni::DEVICE_STATE_EOF) state_ = OpenNi2Device::State::kEnded;
    if (state == openni::DEVICE_STATE_ERROR) state_ = OpenNi2Device::State::kFailed;
  }
  void onDeviceDisconnected(const openni::DeviceInfo* info) override {
    if (info != nullptr && uri_ == info->getUri()) state_ = OpenNi2Device::State::kFailed;
  }

 private:
  const std::string uri_;
  std::atomic<OpenNi2Device::State> state_ = OpenNi2Device::State::kPlaying;
};

std::string first_camera() {
  openni::Array<openni::DeviceInfo> devices;
  openni::OpenNI::enumerateDevices(&devices);
  if (devices.getSize() == 0) {
    throw std::runtime_error(
        "no camera found: OpenNI2 lists no device (is it plugged in, and may this user open it?)");
  }
  return devices[0].getUri();
}

/// The offered mode that suits best: of the given size where one is, in one of the formats (best
/// first), nearest to 30 Hz.
void choose_mode(openni::VideoStream& stream, cv::Size size,
                 const std::vector<openni::PixelFormat>& formats) {
  constexpr int kRate_hz = 30;
  const auto& modes = stream.getSensorInfo().getSupportedVideoModes();
  const openni::VideoMode* best = nullptr;
  std::array<long, 3> best_cost{};
  for (int i = 0; i < modes.getSize(); ++i) {
    const openni::VideoMode& mode = modes[i];
    const auto format = std::ranges::find(formats, mode.getPixelFormat());
    if (format == formats.end()) continue;
    const std::array<long, 3> cost = {std::abs(mode.getResolutionX() - size.width) +
                                          std::abs(mode.getResolutionY() - size.height),
                                      format - formats.begin(), std::abs(mode.getFps() - kRate_hz)};
    if (best == nullptr || cost < best_cost) {
      best = &mode;
      best_cost = cost;
    }
  }
  // A .oni file lists the camera's modes and can play only its own: then this changes nothing.
  if (best != nullptr) stream.setVideoMode(*best);
}

}  // namespace

struct OpenNi2Device::Implementation {
  Implementation(const std::string& wanted_uri, const SourceConfig& config)
      : uri(wanted_uri.empty() ? first_camera() : wanted_uri), listener(uri) {
    if (device.open(uri.c_str()) != openni::STATUS_OK) {
      throw std::runtime_error("cannot open device '" + uri + "': " + trimmed_error());
    }
    create(depth, openni::SENSOR_DEPTH, "depth");
    if (device.hasSensor(openni::SENSOR_COLOR)) create(color, openni::SENSOR_COLOR, "colour");
    choose_modes(config.max_range_m);
    if (color.isValid() &&
        device.isImageRegistrationModeSupported(openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR)) {
      device.setImageRegistrationMode(openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR);
    }
    if (openni::PlaybackControl* playback = device.getPlaybackControl()) {
      playback->setRepeatEnabled(false);
      playback->setSpeed(config.replay ? -1.0F : 1.0F);
    }
    start(depth, "depth");
    if (color.isValid()) start(color, "colour");
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

  void start(openni::VideoStream& stream, const char* what) {
    stream.setMirroringEnabled(false);  // what cannot is un-mirrored when it is read
    if (stream.start() != openni::STATUS_OK) fail(what, "started");
  }

  void stop() {
    depth.stop();
    color.stop();
  }

  /// A .oni file, played by OpenNI2's own driver.
  [[nodiscard]] bool is_oni_file() const {
    return device.isFile() && !device.isPropertySupported(kDevicePropertyCalibration);
  }

  void choose_modes(double max_range_m) {
    const openni::VideoMode mode = depth.getVideoMode();
    const cv::Size vga(640, 480);
    const cv::Size own(mode.getResolutionX(), mode.getResolutionY());
    std::vector<openni::PixelFormat> formats = {openni::PIXEL_FORMAT_DEPTH_1_MM,
                                                openni::PIXEL_FORMAT_DEPTH_100_UM};
    if (max_range_m <= kReachOf100um_m) std::ranges::reverse(formats);
    choose_mode(depth, device.isFile() ? own : vga, formats);
    if (color.isValid()) choose_mode(color, size(), {openni::PIXEL_FORMAT_RGB888});
  }

  [[nodiscard]] cv::Size size() const {
    const openni::VideoMode mode = depth.getVideoMode();
    return {mode.getResolutionX(), mode.getResolutionY()};
  }

  [[noreturn]] void fail(const char* what, const char* done) const {
    throw std::runtime_error("the " + std::string(what) + " stream of device '" + uri +
                             "' cannot be " + done + ": " + trimmed_error());
  }

  static std::shared_ptr<Runtime> shared_runtime() {
    static std::mutex mutex;
    static std::weak_ptr<Runtime> current;
    const std::lock_guard lock(mutex);
    auto runtime = current.lock();
    if (!runtime) current = runtime = std::make_shared<Runtime>();
    return runtime;
  }

  const std::shared_ptr<Runtime> runtime = shared_runtime();  // first: outlives all of the below
  const std::string uri;
  StateListener listener;
  openni::Device device;
  openni::VideoStream depth;
  openni::VideoStream color;
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
    throw std::runtime_error("device '" + impl.uri + "': " + trimmed_error());
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
    image.color_rgb = copy_color(frame, mirrored, impl.size());
  }
  return image;
}

OpenNi2Device::State OpenNi2Device::state() const { return implementation_->listener.state(); }

std::string OpenNi2Device::failure() const {
  const openni::Device& device = implementation_->device;
  if (!device.isPropertySupported(kDevicePropertyPlaybackError))
    return "the device reports a fault";
  std::array<char, 1024> text{};
  int size = static_cast<int>(text.size());
  device.getProperty(kDevicePropertyPlaybackError, text.data(), &size);
  return text.data();
}

std::string OpenNi2Device::name() const {
  const openni::DeviceInfo& info = implementation_->device.getDeviceInfo();
  return std::string(info.getVendor()) + " " + info.getName();
}

bool OpenNi2Device::is_recording() const { return implementation_->device.isFile(); }

bool OpenNi2Device::has_color() const { return implementation_->color.isValid(); }

std::optional<int> OpenNi2Device::num_depth_frames() const {
  openni::PlaybackControl* playback = implementation_->device.getPlaybackControl();
  if (playback == nullptr) return std::nullopt;
  return playback->getNumberOfFrames(implementation_->depth);
}

double OpenNi2Device::depth_units_per_m() const {
  const auto format = implementation_->depth.getVideoMode().getPixelFormat();
  return format == openni::PIXEL_FORMAT_DEPTH_100_UM ? 10000.0 : 1000.0;
}

Intrinsics OpenNi2Device::intrinsics() const {
  const openni::Device& device = implementation_->device;
  DeviceCalibration own{};
  int size = sizeof(own);
  if (device.isPropertySupported(kDevicePropertyCalibration) &&
      device.getProperty(kDevicePropertyCalibration, &own, &size) == openni::STATUS_OK) {
    Intrinsics intrinsics{.fx = own.fx,
                          .fy = own.fy,
                          .cx = own.cx,
                          .cy = own.cy,
                          .width = own.width,
                          .height = own.height,
                          .distortion = {}};
    std::ranges::copy(own.distortion, intrinsics.distortion.begin());
    return intrinsics;
  }
  const openni::VideoStream& depth = implementation_->depth;
  const cv::Size image = implementation_->size();
  const auto focal_length = [](int pixels, double field_of_view_rad) {
    return 0.5 * pixels / std::tan(0.5 * field_of_view_rad);
  };
  return {.fx = focal_length(image.width, depth.getHorizontalFieldOfView()),
          .fy = focal_length(image.height, depth.getVerticalFieldOfView()),
          .cx = 0.5 * image.width,  // as OpenNI2's own CoordinateConverter has it
          .cy = 0.5 * image.height,
          .width = image.width,
          .height = image.height,
          .distortion = {}};
}

}  // namespace kintsugi::mapper

#pragma once
// An ordinary OpenNI2 client, a few lines long, for the tests.

#include <array>
#include <atomic>
#include <cstring>
#include <string>
#include <vector>

#include <OpenNI.h>
#include <opencv2/core.hpp>

namespace kintsugi::mapper::test {

/// OpenNI2 for as long as a test runs; and what became of the devices meanwhile.
class OpenNi2Session : public openni::OpenNI::DeviceStateChangedListener {
 public:
  OpenNi2Session() {
    status_ = openni::OpenNI::initialize();
    openni::OpenNI::addDeviceStateChangedListener(this);
  }
  ~OpenNi2Session() override {
    openni::OpenNI::removeDeviceStateChangedListener(this);
    openni::OpenNI::shutdown();
  }
  OpenNi2Session(const OpenNi2Session&) = delete;
  OpenNi2Session& operator=(const OpenNi2Session&) = delete;

  [[nodiscard]] openni::Status status() const { return status_; }
  [[nodiscard]] openni::DeviceState device_state() const { return device_state_; }

  void onDeviceStateChanged(const openni::DeviceInfo* /*info*/,
                            openni::DeviceState state) override {
    device_state_ = state;
  }

 private:
  openni::Status status_ = openni::STATUS_ERROR;
  std::atomic<openni::DeviceState> device_state_ = openni::DEVICE_STATE_OK;
};

struct ClientFrame {
  int index = 0;
  std::int64_t utime = 0;
  cv::Mat image;
};

inline ClientFrame copy_frame(const openni::VideoFrameRef& frame) {
  const int type = frame.getSensorType() == openni::SENSOR_DEPTH ? CV_16UC1 : CV_8UC3;
  const cv::Mat view(frame.getHeight(), frame.getWidth(), type, const_cast<void*>(frame.getData()),
                     static_cast<std::size_t>(frame.getStrideInBytes()));
  return {.index = frame.getFrameIndex(),
          .utime = static_cast<std::int64_t>(frame.getTimestamp()),
          .image = view.clone()};
}

/// Depth and colour of one device.
class Client {
 public:
  explicit Client(const std::string& uri) {
    status_ = device_.open(uri.c_str());
    if (status_ != openni::STATUS_OK) {
      error_ = openni::OpenNI::getExtendedError();
      return;
    }
    depth_.create(device_, openni::SENSOR_DEPTH);
    if (device_.hasSensor(openni::SENSOR_COLOR)) color_.create(device_, openni::SENSOR_COLOR);
  }
  ~Client() {
    depth_.stop();
    color_.stop();
    depth_.destroy();
    color_.destroy();
    device_.close();
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  [[nodiscard]] bool is_open() const { return status_ == openni::STATUS_OK; }
  [[nodiscard]] const std::string& error() const { return error_; }
  openni::Device& device() { return device_; }
  openni::VideoStream& depth() { return depth_; }
  openni::VideoStream& color() { return color_; }

  void start(float speed, bool repeat = false) {
    device_.getPlaybackControl()->setSpeed(speed);
    device_.getPlaybackControl()->setRepeatEnabled(repeat);
    depth_.start();
    if (color_.isValid()) color_.start();
  }

  /// Reads until nothing comes for `patience_ms` or `max_depth_frames` have come.
  void read_all(int patience_ms = 300, std::size_t max_depth_frames = 10000) {
    std::array<openni::VideoStream*, 2> streams = {&depth_, &color_};
    const int num_streams = color_.isValid() ? 2 : 1;
    int ready = 0;
    while (depth_frames.size() < max_depth_frames &&
           openni::OpenNI::waitForAnyStream(streams.data(), num_streams, &ready, patience_ms) ==
               openni::STATUS_OK) {
      openni::VideoFrameRef frame;
      if (streams.at(static_cast<std::size_t>(ready))->readFrame(&frame) != openni::STATUS_OK) {
        continue;
      }
      (ready == 0 ? depth_frames : color_frames).push_back(copy_frame(frame));
    }
  }

  std::vector<ClientFrame> depth_frames;
  std::vector<ClientFrame> color_frames;

 private:
  openni::Device device_;
  openni::VideoStream depth_;
  openni::VideoStream color_;
  openni::Status status_ = openni::STATUS_ERROR;
  std::string error_;
};

}  // namespace kintsugi::mapper::test

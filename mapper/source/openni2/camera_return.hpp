#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "mapper/source/openni2/openni2_device.hpp"

namespace kintsugi::mapper {

/// Waits for a disconnected camera and opens it again.
///
/// Each attempt initialises OpenNI2 again (if this is its only user), because some drivers search
/// for cameras only then. A camera may come back under another address (that of a USB camera
/// contains its device number): one with the same name is taken and, where cameras have serial
/// numbers, with the same number.
class CameraReturn {
 public:
  /// @param camera must be destroyed before the first attempt, because it keeps OpenNI2 initialised
  CameraReturn(const SourceConfig& config, const OpenNi2Device& camera);

  /// Waits until the next attempt is due, at most `patience`, and then makes the attempt if it is
  /// due. Returns nullptr while the camera is not back.
  std::unique_ptr<OpenNi2Device> wait(std::chrono::milliseconds patience);

  [[nodiscard]] double seconds_away() const;

  /// Why the last attempt failed.
  [[nodiscard]] const std::string& last_error() const { return last_error_; }

 private:
  using Clock = std::chrono::steady_clock;

  std::unique_ptr<OpenNi2Device> open_any();
  [[nodiscard]] std::unique_ptr<OpenNi2Device> open(const std::string& uri) const;
  [[nodiscard]] std::vector<std::string> addresses() const;

  SourceConfig config_;
  std::string uri_;  ///< before it was disconnected
  std::string name_;
  std::string serial_number_;
  cv::Size image_size_;
  Clock::time_point gone_ = Clock::now();
  std::chrono::milliseconds pause_{100};
  Clock::time_point next_attempt_ = Clock::now() + pause_;
  std::string last_error_;
};

}  // namespace kintsugi::mapper

#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "mapper/source/openni2/openni2_device.hpp"

namespace kintsugi::mapper {

/// Waits for a camera that went away, and opens it again.
///
/// Each attempt initialises OpenNI2 anew (when this is its only user): only then do its drivers
/// look for cameras where the system does not tell them. A camera may come back under another
/// address (a USB camera's contains its device number): one of the same name is taken, and, where
/// cameras have serial numbers, of the same number.
class CameraReturn {
 public:
  /// @param camera must be gone before the first attempt: it holds OpenNI2.
  CameraReturn(const SourceConfig& config, const OpenNi2Device& camera);

  /// Waits `patience` or until the next attempt is due, whichever is shorter; attempts then.
  /// nullptr: not yet.
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
  std::string uri_;  ///< that it had
  std::string name_;
  std::string serial_number_;
  cv::Size image_size_;
  Clock::time_point gone_ = Clock::now();
  std::chrono::milliseconds pause_{100};
  Clock::time_point next_attempt_ = Clock::now() + pause_;
  std::string last_error_;
};

}  // namespace kintsugi::mapper

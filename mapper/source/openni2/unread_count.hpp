#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "mapper/openni2_driver/recording/device_properties.hpp"

namespace kintsugi::mapper {

/// Counts the images of a recording that the driver passed over, and tells them from those that
/// came too fast: in the numbers of the frames both leave a gap.
class UnreadCount {
 public:
  /// @param now what the device says at present
  /// @return what to tell a person, about the first image only
  std::optional<std::string> update(const UnreadImages& now);

  /// Of `missing` numbers between two depth images, those that were passed over.
  std::int64_t explain_gap(std::int64_t missing);

  /// The device was closed; it counts from 0 when it is opened again.
  void device_closed() { device_ = {}; }

  [[nodiscard]] std::int64_t total() const { return total_; }

  /// A sentence for the end; empty when every image was read.
  [[nodiscard]] std::string summary() const;

 private:
  UnreadImages device_{};  ///< its last answer
  std::int64_t total_ = 0;
  std::int64_t depth_unexplained_ = 0;  ///< whose gap has not been met yet
};

}  // namespace kintsugi::mapper

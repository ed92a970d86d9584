#pragma once
// What a device of our OpenNI2 driver plays back.

#include <cstdint>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::mapper {

/// Unit of a raw depth value; both are pixel formats of OpenNI2. Raw 0 is always "no measurement".
enum class DepthUnit {
  k1mm,    ///< reaches 32.767 m: a .oni file of OpenNI2 keeps no greater value
  k100um,  ///< reaches 6.5534 m
};

constexpr double units_per_m(DepthUnit unit) { return unit == DepthUnit::k1mm ? 1000.0 : 10000.0; }

/// The greatest valid raw value; depth beyond it is 0. 65535 stays free, some mean "invalid" by it.
constexpr int max_depth_value(DepthUnit unit) { return unit == DepthUnit::k1mm ? 32767 : 65534; }

/// A finite sequence of depth images and one of colour images, each with its own times, seen by one
/// pinhole camera (colour is registered to depth).
///
/// Frames are numbered from 0 and their times ascend strictly within each sequence; the two
/// sequences need not have the same length or the same times. Reading a frame is deterministic and
/// may be repeated in any order. The object is used by one thread at a time.
class Recording {
 public:
  virtual ~Recording() = default;

  /// For people, such as the scheme and the last part of the path.
  [[nodiscard]] virtual std::string name() const = 0;

  /// Of both sequences; `distortion` is the lens's own, the images are as the lens made them.
  [[nodiscard]] virtual const Intrinsics& intrinsics() const = 0;

  /// Nominal, at least 1.
  [[nodiscard]] virtual int frame_rate_hz() const = 0;

  /// The unit that loses nothing within its reach. A k100um recording is readable as k1mm too.
  [[nodiscard]] virtual DepthUnit finest_depth_unit() const = 0;

  [[nodiscard]] virtual int num_depth_frames() const = 0;  ///< > 0
  [[nodiscard]] virtual int num_color_frames() const = 0;  ///< 0: no colour

  /// When it was taken, microseconds, >= 0. The index must be in range.
  [[nodiscard]] virtual std::int64_t depth_utime(int index) const = 0;
  [[nodiscard]] virtual std::int64_t color_utime(int index) const = 0;

  /// What the device writes on an image: its time, unless an imitated clock is wrong.
  [[nodiscard]] virtual std::int64_t depth_stamp(int index) const { return depth_utime(index); }
  [[nodiscard]] virtual std::int64_t color_stamp(int index) const { return color_utime(index); }

  /// Colour images come so much later than depth images of their time.
  [[nodiscard]] virtual std::int64_t color_delay_us() const { return 0; }

  /// height x width along C's z, in `unit`; 0 is invalid.
  /// @throws std::runtime_error naming the file when it cannot be read.
  [[nodiscard]] virtual cv::Mat_<std::uint16_t> depth(int index, DepthUnit unit) = 0;

  /// height x width, red first.
  /// @throws std::runtime_error naming the file when it cannot be read.
  [[nodiscard]] virtual cv::Mat_<cv::Vec3b> color(int index) = 0;

  /// True pose of the camera at a depth frame, where it is known.
  [[nodiscard]] virtual std::optional<Pose> depth_X_WC(int /*index*/) const { return std::nullopt; }
};

}  // namespace kintsugi::mapper

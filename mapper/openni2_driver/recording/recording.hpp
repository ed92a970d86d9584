#pragma once
// What a device of our OpenNI2 driver plays.

#include <cstdint>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::mapper {

/// Unit of a raw depth value; both are pixel formats of OpenNI2. Raw 0 is always "no measurement".
enum class DepthUnit {
  k1mm,    ///< range 32.767 m: a .oni file of OpenNI2 cannot store greater values
  k100um,  ///< range 6.5534 m
};

constexpr double units_per_m(DepthUnit unit) { return unit == DepthUnit::k1mm ? 1000.0 : 10000.0; }

/// The greatest valid raw value; depth beyond it is 0. Not 65535, which often means "invalid".
constexpr int max_depth_value(DepthUnit unit) { return unit == DepthUnit::k1mm ? 32767 : 65534; }

/// A sequence of depth images and one of colour images, each with its own times, of one camera
/// (colour is registered to depth).
///
/// Frames are numbered from 0, and times ascend strictly within each sequence; the sequences may
/// differ in length and times. Frames can be read repeatedly and in any order, with the same
/// result. To be used by one thread at a time.
class Recording {
 public:
  virtual ~Recording() = default;

  /// Name for people.
  [[nodiscard]] virtual std::string name() const = 0;

  /// What a person should know about how the recording is read, a sentence; empty: nothing.
  [[nodiscard]] virtual std::string remark() const { return ""; }

  /// Of both sequences. The images have the lens distortion that `distortion` describes. fy < 0:
  /// C's y axis points up in the images.
  [[nodiscard]] virtual const Intrinsics& intrinsics() const = 0;

  /// Nominal, at least 1.
  [[nodiscard]] virtual int frame_rate_hz() const = 0;

  /// The unit without loss of precision. A k100um recording can be read as k1mm, too.
  [[nodiscard]] virtual DepthUnit finest_depth_unit() const = 0;

  [[nodiscard]] virtual int num_depth_frames() const = 0;  ///< > 0
  [[nodiscard]] virtual int num_color_frames() const = 0;  ///< 0: no colour

  /// When the image was taken, microseconds, >= 0. The index must be in range.
  [[nodiscard]] virtual std::int64_t depth_utime(int index) const = 0;
  [[nodiscard]] virtual std::int64_t color_utime(int index) const = 0;

  /// Time stamp that the device gives an image: its time, unless an imitated clock is wrong.
  [[nodiscard]] virtual std::int64_t depth_stamp(int index) const { return depth_utime(index); }
  [[nodiscard]] virtual std::int64_t color_stamp(int index) const { return color_utime(index); }

  /// Delay of colour images relative to depth images of the same time.
  [[nodiscard]] virtual std::int64_t color_delay_us() const { return 0; }

  /// height x width along C's z, in `unit`; 0 is invalid.
  /// @throws std::runtime_error naming the file when it cannot be read
  [[nodiscard]] virtual cv::Mat_<std::uint16_t> depth(int index, DepthUnit unit) = 0;

  /// height x width, red first.
  /// @throws std::runtime_error naming the file when it cannot be read
  [[nodiscard]] virtual cv::Mat_<cv::Vec3b> color(int index) = 0;

  /// True camera pose at a depth frame, if known.
  [[nodiscard]] virtual std::optional<Pose> depth_X_WC(int /*index*/) const { return std::nullopt; }
};

}  // namespace kintsugi::mapper

#pragma once

#include <optional>
#include <span>
#include <string>

#include <opencv2/core.hpp>

namespace kintsugi::mapper {

/// Size and rate of a stream, as a device offers them.
struct DeviceMode {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  int rate_hz = 0;

  /// Reads `WIDTHxHEIGHT@HZ` or `WIDTHxHEIGHT` (rate 0: any), such as `640x480@30`.
  /// @param field what the text is of, for the error.
  /// @throws std::invalid_argument naming field, text and what was expected.
  static DeviceMode parse(const std::string& field, const std::string& text);

  [[nodiscard]] cv::Size size() const { return {width, height}; }

  bool operator==(const DeviceMode&) const = default;
};

/// `640x480@30`
std::string to_string(const DeviceMode& mode);

/// The offered modes, each once, largest first, separated by blanks.
std::string list_of(std::span<const DeviceMode> offered);

/// Index of the mode to use: the first of those nearest to `wanted` in size, then in rate.
/// nullopt when nothing is offered.
std::optional<std::size_t> nearest_mode(std::span<const DeviceMode> offered,
                                        const DeviceMode& wanted);

/// Index of the first offered mode of the size, and where it is not 0 the rate, of `wanted`; where
/// the rate is 0, of the mode nearest to 30 Hz.
std::optional<std::size_t> find_mode(std::span<const DeviceMode> offered, const DeviceMode& wanted);

/// The part of a colour image of `color` pixels that a registered depth image of `depth` pixels
/// sees: the full width, from the top as many rows as give it the depth image's shape; nullopt when
/// the colour image has not so many.
///
/// A 1280x1024 image of the PrimeSense cameras (Kinect, Xtion, Carmine) is the whole sensor, a
/// 640x480 one its first 960 rows binned by two; depth is registered to the latter, so the last 64
/// rows see nothing of it.
std::optional<cv::Rect> registered_part(cv::Size color, cv::Size depth);

}  // namespace kintsugi::mapper

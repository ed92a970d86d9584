#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "mapper/core/frame/rgbd_frame.hpp"

namespace kintsugi::mapper {

/// What became of the images that a source was given.
struct SourceCounts {
  std::int64_t frames_delivered = 0;  ///< returned by next()
  std::int64_t frames_dropped = 0;    ///< replaced by a newer frame before next() was called
  std::int64_t depth_unpaired = 0;    ///< delivered without colour: none within half a frame period
  std::int64_t color_unpaired = 0;    ///< colour images without a depth image
  std::int64_t frames_bad = 0;        ///< refused: missing, not to be decoded, of another size
  std::int64_t interruptions = 0;     ///< how often the camera was disconnected
  double convert_ms = 0.0;            ///< time spent on conversion to metres and undistortion
};

/// What a source knows about itself.
struct SourceStatus {
  std::string name;                ///< of the device, for people
  std::int64_t frames_total = -1;  ///< depth images of a recording; -1: not known (a live camera)
  SourceCounts counts;
  std::string end_reason;  ///< why next() returned nullopt, a sentence; empty before that
  /// False when the recording ended before its announced length or the device failed. The frames
  /// delivered until then are good.
  bool ended_well = true;
};

/// A source of RGB-D frames: undistorted, not mirrored, depth in metres, colour paired by time.
///
/// A recording gives every frame as fast as next() is called. A live source (a camera, the bus)
/// replaces waiting frames by newer ones when next() is called too late.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// Waits for the next frame. Returns nullopt at the end and on every later call. To be called
  /// from one thread. Times of frames ascend strictly, whatever the clock of the device does; after
  /// an interruption they continue with the time that has passed.
  virtual std::optional<RgbdFrame> next() = 0;

  /// Name and frames_total are known from the beginning. To be called from the thread of next().
  [[nodiscard]] virtual SourceStatus status() const = 0;
};

}  // namespace kintsugi::mapper

#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace kintsugi::mapper {

/// Converts the time stamps of depth and colour images to times that ascend in each stream, even if
/// the clock of the device jumps.
///
/// Time stamps are passed on unchanged as long as they are plausible. When they step back, or those
/// of a live device deviate by more than a second from the elapsed time, a new epoch begins: its
/// first image is placed after the previous one by the elapsed time, and the device clock counts
/// from there. Both streams share one clock: the stream that notices the jump second joins the
/// epoch of the first.
class DeviceClock {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  enum class Stream : std::uint8_t { kDepth = 0, kColor = 1 };

  /// @param live images arrive as fast as they are taken
  /// @param period_us nominal time between two images
  DeviceClock(bool live, std::int64_t period_us) : live_(live), period_us_(period_us) {}

  /// The time of an image with time stamp `stamp_us` that arrived at `arrival`.
  std::int64_t time_of(Stream stream, std::int64_t stamp_us, Instant arrival);

  /// The device was disconnected: the elapsed time counts for the next image, even of a recording.
  void interrupt();

 private:
  /// State of one stream.
  struct Line {
    bool seen = false;
    bool interrupted = false;
    std::int64_t stamp_us = 0;   ///< of the last image, by the device's clock
    std::int64_t time_us = 0;    ///< ... and by ours
    Instant arrival;             ///< ... and when it came
    std::int64_t offset_us = 0;  ///< ours - the device's
    int epoch = 0;
  };

  [[nodiscard]] bool goes_on(const Line& line, std::int64_t stamp_us, Instant arrival) const;
  void begin_epoch(const Line& line, std::int64_t stamp_us, Instant arrival);

  bool live_;
  std::int64_t period_us_;
  std::array<Line, 2> lines_;
  int epoch_ = 0;
  std::int64_t offset_us_ = 0;  ///< of the epoch
};

}  // namespace kintsugi::mapper

#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace kintsugi::mapper {

/// Turns the times that a device writes on its depth and colour images into times that ascend, in
/// each stream, whatever the device's clock does.
///
/// The device's own times are passed on for as long as its clock goes on sensibly. When it steps
/// back, or (live) strays by more than a second from the time that has passed, a new epoch begins:
/// its first image comes so long after the one before as has passed meanwhile, and the device's
/// clock counts from there. Both streams have one clock: the second one to notice joins the epoch
/// that the first one began.
class DeviceClock {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  enum class Stream : std::uint8_t { kDepth = 0, kColor = 1 };

  /// @param live images come at the pace at which they are taken.
  /// @param period_us nominal time between two images.
  DeviceClock(bool live, std::int64_t period_us) : live_(live), period_us_(period_us) {}

  /// The time of an image that the device dated `stamp_us` and that came at `arrival`.
  std::int64_t time_of(Stream stream, std::int64_t stamp_us, Instant arrival);

  /// The device has been away: what has passed meanwhile has passed here, even in a replay.
  void interrupt();

 private:
  /// What is known of one stream's images.
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

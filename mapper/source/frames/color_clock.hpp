#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace kintsugi::mapper {

/// Finds out when a device dates its colour images by another clock than its depth images (the
/// streams of some recordings each count from their own start).
///
/// Images that come one after the other were taken at about the same time. When the times of colour
/// images are off from those of the depth images among which they come by more than three periods,
/// steadily, that is the difference of the clocks. Less may be lateness and is left as it is.
class ColorClock {
 public:
  explicit ColorClock(std::int64_t period_us) : period_us_(period_us) {}

  void add_depth(std::int64_t utime);

  /// `utime` by the depth images' clock, as far as it is known.
  std::int64_t add_color(std::int64_t utime);

  /// So far the colour images' clock is ahead.
  [[nodiscard]] std::int64_t ahead_us() const { return ahead_us_; }

 private:
  std::int64_t period_us_;
  std::int64_t ahead_us_ = 0;
  std::optional<std::int64_t> last_color_;  ///< by its own clock; absent: none since the last depth
  std::deque<std::int64_t> differences_us_;  ///< colour - depth, of the last depth images
};

}  // namespace kintsugi::mapper

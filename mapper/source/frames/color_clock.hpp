#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace kintsugi::mapper {

/// Detects that the time stamps of the colour images come from another clock than those of the
/// depth images (in some recordings each stream counts from its own start).
///
/// Images that arrive one after the other were taken at about the same time. If the times of colour
/// images steadily differ by more than three periods from those of the depth images between which
/// they arrive, the difference is the offset of the clocks. A smaller one may be a delay and is not
/// corrected.
class ColorClock {
 public:
  explicit ColorClock(std::int64_t period_us) : period_us_(period_us) {}

  void add_depth(std::int64_t utime);

  /// Converts `utime` to the clock of the depth images, as far as the offset is known.
  std::int64_t add_color(std::int64_t utime);

  /// Offset of the colour clock: colour time minus depth time, microseconds.
  [[nodiscard]] std::int64_t ahead_us() const { return ahead_us_; }

 private:
  std::int64_t period_us_;
  std::int64_t ahead_us_ = 0;
  std::optional<std::int64_t> last_color_;  ///< by its own clock; absent: none since the last depth
  std::deque<std::int64_t> differences_us_;  ///< colour - depth, of the last depth images
};

}  // namespace kintsugi::mapper

#include "mapper/source/frames/color_clock.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

namespace kintsugi::mapper {

void ColorClock::add_depth(std::int64_t utime) {
  constexpr std::size_t kEnough = 9;
  constexpr std::int64_t kMaxLateness_periods = 3;
  const auto color = std::exchange(last_color_, std::nullopt);
  if (!color) return;
  differences_us_.push_back(*color - utime);
  if (differences_us_.size() < kEnough) return;
  if (differences_us_.size() > kEnough) differences_us_.pop_front();

  std::vector<std::int64_t> sorted(differences_us_.begin(), differences_us_.end());
  std::ranges::sort(sorted);
  const std::int64_t median = sorted[kEnough / 2];
  const bool steady = sorted.back() - sorted.front() <= 2 * period_us_;
  const bool wrong = std::abs(median - ahead_us_) > kMaxLateness_periods * period_us_;
  if (steady && wrong) ahead_us_ = median;
}

std::int64_t ColorClock::add_color(std::int64_t utime) {
  last_color_ = utime;
  return utime - ahead_us_;
}

}  // namespace kintsugi::mapper

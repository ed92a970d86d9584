#include "mapper/openni2_driver/formats/frame_stamps.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "mapper/openni2_driver/formats/frame_numbers.hpp"

namespace kintsugi::mapper {

std::optional<std::vector<std::int64_t>> times_of_stamps(const std::vector<std::uint64_t>& stamps) {
  if (stamps.size() < 2 ||
      std::ranges::adjacent_find(stamps, std::greater_equal()) != stamps.end()) {
    return std::nullopt;
  }
  std::vector<std::uint64_t> steps;
  steps.reserve(stamps.size() - 1);
  for (std::size_t i = 1; i < stamps.size(); ++i) steps.push_back(stamps[i] - stamps[i - 1]);
  const auto median = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, median);
  constexpr double kShortest_us = 2e3;
  constexpr double kLongest_us = 2e6;
  for (const double unit_us : {1e6, 1e3, 1.0, 1e-3}) {
    const double step_us = static_cast<double>(*median) * unit_us;
    if (step_us < kShortest_us || step_us >= kLongest_us) continue;
    std::vector<std::int64_t> utimes;
    utimes.reserve(stamps.size());
    for (const std::uint64_t stamp : stamps) {
      // From the first one on, as a double does not have the microseconds of today's date.
      const auto utime = std::llround(static_cast<double>(stamp - stamps.front()) * unit_us);
      if (!utimes.empty() && utime <= utimes.back()) return std::nullopt;
      utimes.push_back(utime);
    }
    return utimes;
  }
  return std::nullopt;
}

std::vector<std::int64_t> times_of_numbers(std::size_t num_frames) {
  std::vector<std::int64_t> utimes;
  utimes.reserve(num_frames);
  for (std::size_t i = 0; i < num_frames; ++i) {
    utimes.push_back(time_of_frame(static_cast<std::int64_t>(i)));
  }
  return utimes;
}

}  // namespace kintsugi::mapper

#include "mapper/openni2_driver/plugin/rate_filter.hpp"

namespace kintsugi::mapper {

bool RateFilter::passes(std::int64_t utime, int mode_rate_hz, int recorded_rate_hz) {
  const std::int64_t interval_us = 1'000'000 / mode_rate_hz;
  const std::int64_t half_recorded_us = 500'000 / recorded_rate_hz;
  const bool too_soon = last_utime_ >= 0 && mode_rate_hz < recorded_rate_hz &&
                        utime < last_utime_ + interval_us - half_recorded_us;
  if (too_soon) {
    ++num_left_out_;
  } else {
    last_utime_ = utime;
  }
  return !too_soon;
}

}  // namespace kintsugi::mapper

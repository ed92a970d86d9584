#include "viewer/output/video_clock.hpp"

#include <algorithm>
#include <cmath>

namespace kintsugi::viewer {

bool VideoClock::goes_on(std::int64_t utime) const {
  return first_utime_ && utime >= last_utime_ &&
         1e-6 * static_cast<double>(utime - last_utime_) <= kLeap_s;
}

int VideoClock::due(std::int64_t utime) const {
  if (!goes_on(utime)) return 1;
  // Times are whole microseconds: half of one keeps a picture at exactly its time from being late.
  const double elapsed_s = 1e-6 * (static_cast<double>(utime - *first_utime_) + 0.5);
  const auto passed = static_cast<std::int64_t>(std::floor(elapsed_s * rate_hz_)) + 1;
  return static_cast<int>(std::max<std::int64_t>(passed - pictures_, 0));
}

void VideoClock::note(std::int64_t utime, int pictures) {
  if (!goes_on(utime)) {
    const double before_us = 1e6 * static_cast<double>(pictures_) / rate_hz_;
    first_utime_ = utime - static_cast<std::int64_t>(before_us);
  }
  last_utime_ = utime;
  pictures_ += pictures;
}

}  // namespace kintsugi::viewer

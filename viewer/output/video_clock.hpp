#pragma once

#include <cstdint>
#include <optional>

namespace kintsugi::viewer {

/// Counts which pictures of a video are due: one for each period of map time, however fast that
/// passes, so that the video takes as long as what was recorded.
class VideoClock {
 public:
  /// `rate_hz`: pictures in a second of map time
  explicit VideoClock(double rate_hz) : rate_hz_(rate_hz) {}

  /// Pictures that are due at this device time and not noted yet; 1 at the first time. When the
  /// time goes back or leaps, because another recording has begun, the video goes on with one
  /// picture.
  int due(std::int64_t utime) const;

  /// So many pictures have been added at this time.
  void note(std::int64_t utime, int pictures);

 private:
  static constexpr double kLeap_s = 600.0;  ///< longer than any pause that one waits for

  bool goes_on(std::int64_t utime) const;

  double rate_hz_;
  std::optional<std::int64_t> first_utime_;  // the time of picture 0 by the present recording
  std::int64_t last_utime_ = 0;
  std::int64_t pictures_ = 0;
};

}  // namespace kintsugi::viewer

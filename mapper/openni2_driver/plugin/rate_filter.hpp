#pragma once

#include <cstdint>

namespace kintsugi::mapper {

/// Reduces the frame rate to that of a mode: keeps the images nearest to the times of the mode.
class RateFilter {
 public:
  void restart() { *this = {}; }

  /// @param utime time of the image
  bool passes(std::int64_t utime, int mode_rate_hz, int recorded_rate_hz);

  [[nodiscard]] int num_left_out() const { return num_left_out_; }

 private:
  std::int64_t last_utime_ = -1;  ///< of the last image that passed; -1: none
  int num_left_out_ = 0;
};

}  // namespace kintsugi::mapper

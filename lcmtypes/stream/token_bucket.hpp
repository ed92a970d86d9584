#pragma once
// Limits a rate, without a clock.

#include <algorithm>

namespace kintsugi {

/// A token bucket: it allows a rate in bytes per second on average, and a burst of bytes at once
/// after a pause.
///
/// A message larger than the burst may pass when the bucket is full; the next one then waits
/// longer.
class TokenBucket {
 public:
  TokenBucket(double rate_bytes_per_s, double burst_bytes)
      : rate_bytes_per_s_(rate_bytes_per_s), burst_bytes_(burst_bytes), tokens_(burst_bytes) {}

  /// Seconds from `now_s` until a message of `bytes` may be sent; 0: now. `now_s` never decreases.
  double delay_s(double bytes, double now_s) {
    refill(now_s);
    const double missing = std::min(bytes, burst_bytes_) - tokens_;
    return missing > 0.0 ? missing / rate_bytes_per_s_ : 0.0;
  }

  /// To be called when a message of `bytes` is sent.
  void take(double bytes, double now_s) {
    refill(now_s);
    tokens_ -= bytes;
  }

 private:
  void refill(double now_s) {
    tokens_ = std::min(burst_bytes_, tokens_ + (now_s - last_s_) * rate_bytes_per_s_);
    last_s_ = now_s;
  }

  double rate_bytes_per_s_;
  double burst_bytes_;
  double tokens_;
  double last_s_ = 0.0;
};

}  // namespace kintsugi

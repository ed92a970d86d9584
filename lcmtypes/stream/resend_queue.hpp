#pragma once
// Which chunk of a stream goes next: a new one, or one that somebody asked for again.

#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "lcmtypes/stream/sequence_set.hpp"

namespace kintsugi {

/// What was asked for and has not been sent since, first asked first. No thread, no clock: times
/// are seconds that never decrease.
class ResendQueue {
 public:
  /// A request that comes this soon after the chunk was sent has crossed it: not asked for. Below
  /// the time that a receiver waits before it first asks. Seconds.
  static constexpr double kInFlight_s = 0.05;
  /// While new chunks wait too, one in so many chunks is a resend.
  static constexpr int kResendEvery = 8;

  /// Somebody asks for `ranges`; what is outside [first, end) cannot be sent. However absurd the
  /// ranges, the cost is bounded by their number and by what can be sent.
  void want(std::span<const SequenceRange> ranges, std::int64_t first, std::int64_t end,
            double now_s);

  /// Takes what goes next: the number to resend; nothing: a new chunk, or nothing at all.
  std::optional<std::int64_t> next(bool new_chunk_waits);

  /// A chunk was sent, new or again.
  void sent(std::int64_t sequence, double now_s);

  bool empty() const { return order_.empty(); }
  std::int64_t size() const { return size_; }

 private:
  struct Sent {
    double time_s = 0.0;
    std::int64_t sequence = 0;
  };

  void forget_landed(double now_s);

  std::deque<SequenceRange> order_;  // disjoint
  SequenceSet wanted_;               // the numbers in order_
  std::int64_t size_ = 0;            // how many
  std::deque<Sent> sent_;            // less than kInFlight_s ago
  SequenceSet in_flight_;            // the numbers in sent_
  int new_in_a_row_ = 0;
};

}  // namespace kintsugi

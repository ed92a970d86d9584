#pragma once
// Decides whether a sender sends a new chunk next, or resends one that a receiver has requested.

#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "lcmtypes/sequence_set.hpp"

namespace kintsugi {

/// The requested chunks that have not been resent yet, in the order of the requests. It has no
/// thread and no clock: times are seconds that never decrease.
class ResendQueue {
 public:
  /// A request that arrives within this time after the chunk was sent is ignored: the receiver sent
  /// it before the chunk arrived. Shorter than the time that a receiver waits before it requests
  /// a chunk for the first time.
  static constexpr double kInFlight_s = 0.05;
  /// While new chunks wait, one of so many chunks is a resend.
  static constexpr int kResendEvery = 8;

  /// Adds the requested `ranges`, as far as they are in [first, end): other chunks cannot be sent.
  /// The cost is bounded by the number of ranges and of chunks in [first, end), whatever was
  /// requested.
  void want(std::span<const SequenceRange> ranges, std::int64_t first, std::int64_t end,
            double now_s);

  /// Removes and returns the number of the chunk to resend next; nothing: a new chunk is to be
  /// sent, if there is one.
  std::optional<std::int64_t> next(bool new_chunk_waits);

  /// To be called when a chunk was sent, for the first time or again.
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

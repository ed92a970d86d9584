#include "lcmtypes/stream/resend_queue.hpp"

#include <algorithm>
#include <limits>

namespace kintsugi {
namespace {

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

}  // namespace

void ResendQueue::want(std::span<const SequenceRange> ranges, std::int64_t first, std::int64_t end,
                       double now_s) {
  forget_landed(now_s);
  SequenceSet asked;  // disjoint, however often the request names a number
  for (const auto& range : ranges) {
    const SequenceRange there{std::max(range.first, first), std::min(range.last, end - 1)};
    if (there.first <= there.last) asked.insert(there);
  }
  for (const auto& range : asked.ranges()) {
    for (const auto& gap : wanted_.missing(range.first, range.last + 1, kAll)) {
      for (const auto& landed : in_flight_.missing(gap.first, gap.last + 1, kAll)) {
        wanted_.insert(landed);
        order_.push_back(landed);
        size_ += landed.last - landed.first + 1;
      }
    }
  }
}

std::optional<std::int64_t> ResendQueue::next(bool new_chunk_waits) {
  if (order_.empty()) {
    new_in_a_row_ = 0;
    return std::nullopt;
  }
  if (new_chunk_waits && ++new_in_a_row_ < kResendEvery) return std::nullopt;
  new_in_a_row_ = 0;
  SequenceRange& range = order_.front();
  const std::int64_t sequence = range.first++;
  if (range.first > range.last) order_.pop_front();
  wanted_.erase(sequence);
  --size_;
  return sequence;
}

void ResendQueue::sent(std::int64_t sequence, double now_s) {
  forget_landed(now_s);
  if (in_flight_.insert(sequence)) sent_.push_back({now_s, sequence});
}

void ResendQueue::forget_landed(double now_s) {
  while (!sent_.empty() && now_s - sent_.front().time_s >= kInFlight_s) {
    in_flight_.erase(sent_.front().sequence);
    sent_.pop_front();
  }
}

}  // namespace kintsugi

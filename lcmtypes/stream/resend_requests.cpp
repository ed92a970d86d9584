#include "lcmtypes/stream/resend_requests.hpp"

#include <algorithm>
#include <utility>

namespace kintsugi {
namespace {

/// Cuts the ranges to their lowest `count` numbers, at least one.
std::vector<SequenceRange> first_numbers(std::vector<SequenceRange> ranges, std::int64_t count) {
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const std::int64_t size = ranges[i].last - ranges[i].first + 1;
    if (size >= count) {
      ranges[i].last = ranges[i].first + std::max<std::int64_t>(count, 1) - 1;
      ranges.resize(i + 1);
      break;
    }
    count -= size;
  }
  return ranges;
}

}  // namespace

void ResendRequests::arrived(const SequenceRange& chunks) {
  if (asked_ && asked_->first <= chunks.last && chunks.first <= asked_->last) has_progress_ = true;
}

std::vector<SequenceRange> ResendRequests::poll(const SequenceSet& seen, std::int64_t begin,
                                                std::int64_t end, const Limits& limits, bool heard,
                                                double now_s) {
  note_hearing(heard, now_s);
  const std::int64_t overdue = std::min(overdue_end(end, now_s), limits.end);
  const std::int64_t lowest = seen.lowest_missing(begin);
  if (lowest >= end) {
    asked_.reset();
    has_progress_ = false;
    has_given_up_ = false;
  }
  if (lowest >= overdue) return {};

  if (!asked_ || std::exchange(has_progress_, false)) start_afresh(now_s);
  if (asked_ && lowest > asked_->last) next_ask_s_ = now_s;  // everything requested was received
  if (!has_given_up_ && now_s - in_vain_since_s_ >= config_.give_up_after_s) {
    has_given_up_ = true;
    was_heard_ = false;
    next_ask_s_ = now_s + config_.retry_period_s;
  }
  if (now_s < next_ask_s_ || (has_given_up_ && !was_heard_)) return {};
  was_heard_ = false;
  next_ask_s_ = now_s + (has_given_up_ ? config_.retry_period_s : wait_s_);
  wait_s_ = std::min(2.0 * wait_s_, config_.max_wait_s);
  auto ranges = first_numbers(seen.missing(lowest, overdue, limits.max_ranges), limits.max_numbers);
  asked_ = {ranges.front().first, ranges.back().last};
  return ranges;
}

void ResendRequests::pause(double now_s) {
  in_vain_since_s_ = now_s;
  wait_s_ = config_.min_wait_s;
}

/// The sender answers, or there is something new to request.
void ResendRequests::start_afresh(double now_s) {
  has_given_up_ = false;
  in_vain_since_s_ = now_s;
  wait_s_ = config_.min_wait_s;
  next_ask_s_ = asked_ ? std::min(next_ask_s_, now_s + wait_s_) : now_s;
}

void ResendRequests::note_hearing(bool heard, double now_s) {
  if (!heard) return;
  if (now_s - last_heard_s_ > config_.silence_s) asked_.reset();  // the sender is back
  last_heard_s_ = now_s;
  was_heard_ = true;
}

/// The end of the numbers that have been known for first_wait_s.
std::int64_t ResendRequests::overdue_end(std::int64_t end, double now_s) {
  if (!marks_.empty() && end < marks_.back().end)
    marks_.clear();  // the sender has corrected itself
  if (marks_.empty() || end > marks_.back().end) marks_.push_back({now_s, end});
  const auto is_overdue = [&](const Mark& mark) {
    return now_s - mark.time_s >= config_.first_wait_s;
  };
  while (marks_.size() > 1 && is_overdue(marks_[1])) marks_.pop_front();
  return is_overdue(marks_.front()) ? marks_.front().end : 0;
}

}  // namespace kintsugi

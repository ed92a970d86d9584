#include "lcmtypes/signing/seen_messages.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "lcmtypes/signing/signed_message.hpp"

namespace kintsugi {

bool SeenMessages::take(std::uint64_t session, std::int64_t sequence) {
  if (sequence < 1 || sequence == std::numeric_limits<std::int64_t>::max()) return false;
  const auto sender = find_or_begin(session);
  if (sender == senders_.end()) return false;
  SequenceSet& numbers = sender->numbers;
  const std::size_t ranges_before = numbers.num_ranges();
  if (!numbers.insert(sequence)) return false;
  if (numbers.num_ranges() > limits_.gaps_per_session) {
    numbers.insert(numbers.missing(1, std::numeric_limits<std::int64_t>::max(), 1).front());
  }
  num_ranges_ += numbers.num_ranges() - ranges_before;  // modulo 2^64: it may have become smaller
  senders_.splice(senders_.end(), senders_, sender);
  while (num_ranges_ > limits_.gaps && senders_.size() > 1) forget_longest_silent();
  return true;
}

/// end(): the session may have been forgotten.
SeenMessages::Senders::iterator SeenMessages::find_or_begin(std::uint64_t session) {
  const auto known = by_session_.find(session);
  if (known != by_session_.end()) return known->second;
  if (signed_message::begin_s(session) <= forgotten_s_) return senders_.end();
  senders_.push_back({session, {}});
  return by_session_[session] = std::prev(senders_.end());
}

void SeenMessages::forget_longest_silent() {
  const Sender& sender = senders_.front();
  num_ranges_ -= sender.numbers.num_ranges();
  forgotten_s_ = std::max(forgotten_s_, signed_message::begin_s(sender.session));
  by_session_.erase(sender.session);
  senders_.pop_front();
}

}  // namespace kintsugi

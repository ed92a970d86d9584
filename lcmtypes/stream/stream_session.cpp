#include "lcmtypes/stream/stream_session.hpp"

#include <algorithm>
#include <utility>

namespace kintsugi {
namespace {

// StreamRoom::kOnlyNext: only so many numbers from the lowest missing one on are kept and
// requested.
constexpr std::int64_t kNextChunks = 256;

// Assumed size of a chunk until one is received.
constexpr std::int64_t kUsualChunkBytes = 60'000;

}  // namespace

void StreamSession::hear(const Heartbeat& heartbeat) {
  heard_ = true;
  const bool takes_back = heartbeat.next_sequence < next_ || heartbeat.first_sequence < first_ ||
                          heartbeat.state_sequence < state_;
  if (takes_back && !std::exchange(doubts_, true)) return;
  doubts_ = false;
  next_ = heartbeat.next_sequence;
  first_ = heartbeat.first_sequence;
  state_ = heartbeat.state_sequence;
}

void StreamSession::note(std::int64_t sequence) {
  heard_ = true;
  next_ = std::max(next_, sequence + 1);
}

bool StreamSession::has(std::int64_t sequence) const {
  return sequence < state_ || seen_.contains(sequence);
}

bool StreamSession::takes(std::int64_t sequence, StreamRoom room, std::size_t max_gaps) const {
  if (room == StreamRoom::kNone) return false;
  const std::int64_t lowest = seen_.lowest_missing(state_);
  if (room == StreamRoom::kOnlyNext && sequence >= lowest + kNextChunks) return false;
  return seen_.num_ranges() < max_gaps || sequence == lowest || seen_.contains(sequence - 1) ||
         seen_.contains(sequence + 1);
}

void StreamSession::keep(std::int64_t sequence, std::size_t bytes) {
  seen_.insert(sequence);
  ++chunks_came_;
  bytes_came_ += static_cast<std::int64_t>(bytes);
  lost_requests_.arrived({sequence, sequence});
  requests_.arrived({sequence, sequence});
}

void StreamSession::restore(const std::vector<SequenceRange>& ranges) {
  for (const SequenceRange range : ranges) {
    seen_.insert(range);
    next_ = std::max(next_, range.last + 1);
    chunks_restored_ += range.last - range.first + 1;
  }
}

bool StreamSession::replace(const std::vector<SequenceRange>& ranges, std::size_t max_gaps) {
  heard_ = true;
  if (seen_.num_ranges() + ranges.size() > max_gaps) return false;
  for (const SequenceRange& range : ranges) {
    seen_.insert(range);
    lost_requests_.arrived(range);
    requests_.arrived(range);
  }
  return true;
}

std::vector<SequenceRange> StreamSession::poll(StreamRoom room, std::int64_t max_bytes,
                                               std::size_t max_ranges, double now_s) {
  if (room == StreamRoom::kNone) {
    lost_requests_.pause(now_s);
    requests_.pause(now_s);
    return {};
  }
  const std::int64_t chunk_bytes =
      chunks_came_ > 0 ? std::max<std::int64_t>(1, bytes_came_ / chunks_came_) : kUsualChunkBytes;
  ResendRequests::Limits limits{max_ranges, max_bytes / chunk_bytes, next_};
  if (room == StreamRoom::kOnlyNext) limits.end = seen_.lowest_missing(state_) + kNextChunks;
  const bool heard = std::exchange(heard_, false);
  auto lost = lost_requests_.poll(seen_, state_, resendable(), limits, heard, now_s);
  if (seen_.lowest_missing(state_) < resendable() && !lost_requests_.has_given_up()) {
    requests_.pause(now_s);  // the requested full state will replace the rest, too
    return lost;
  }
  const auto ranges = requests_.poll(seen_, resendable(), next_, limits, heard, now_s);
  lost.insert(lost.end(), ranges.begin(), ranges.end());
  return lost;
}

std::vector<SequenceRange> StreamSession::missing(std::size_t max_ranges) const {
  return seen_.missing(state_, next_, max_ranges);
}

std::int64_t StreamSession::count_missing() const { return seen_.count_missing(state_, next_); }

std::int64_t StreamSession::count_given_up() const {
  const auto count = [this](const ResendRequests& requests, std::int64_t begin, std::int64_t end) {
    return requests.has_given_up() ? seen_.count_missing(begin, end) : 0;
  };
  return count(lost_requests_, state_, resendable()) + count(requests_, resendable(), next_);
}

/// The lowest number that the sender can resend and that no full state replaces.
std::int64_t StreamSession::resendable() const { return std::max(state_, std::min(first_, next_)); }

}  // namespace kintsugi

#include "lcmtypes/stream_subscriber.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "lcmtypes/channels.hpp"

namespace kintsugi {

void StreamSubscriberConfig::validate() const {
  const auto positive = [](const char* name, std::size_t value) {
    if (value == 0) {
      throw std::invalid_argument(std::string("StreamSubscriber: ") + name + " is 0, expected > 0");
    }
  };
  positive("max_pending_bytes", max_pending_bytes);
  positive("max_sessions", max_sessions);
  positive("max_gaps_per_session", max_gaps_per_session);
}

template <BulkMessage Message>
StreamSubscriber<Message>::StreamSubscriber(std::string channel, OnMessage on_message, OnBad on_bad,
                                            const Config& config)
    : channel_(std::move(channel)),
      on_message_(std::move(on_message)),
      on_bad_(std::move(on_bad)),
      config_(config) {
  config_.validate();
}

template <BulkMessage Message>
void StreamSubscriber<Message>::subscribe(Bus& bus) {
  bus.subscribe(channel_, [this](ByteView message) { handle(channel_, message); });
  bus.subscribe(channels::kHeartbeat,
                [this](ByteView message) { handle(channels::kHeartbeat, message); });
}

template <BulkMessage Message>
bool StreamSubscriber<Message>::handle(const std::string& channel, ByteView message) {
  const bool is_heartbeat = channel == channels::kHeartbeat;
  if (!is_heartbeat && channel != channel_) return false;
  std::optional<Message> complete;
  try {
    if (is_heartbeat) {
      add(decode<Heartbeat>(message));
    } else {
      const std::vector<Chunk<Message>> chunks = add(decode_chunk<Message>(message));
      if (!chunks.empty()) complete = join(chunks);
    }
  } catch (const DecodeError& reason) {
    {
      const std::lock_guard lock(mutex_);
      ++counts_.messages_bad;
    }
    if (on_bad_) on_bad_(reason);
  }
  if (complete) on_message_(*std::move(complete));
  return true;
}

/// Keeps the chunk; returns all those of its message when it was the last one missing.
template <BulkMessage Message>
std::vector<Chunk<Message>> StreamSubscriber<Message>::add(Chunk<Message> chunk) {
  const std::lock_guard lock(mutex_);
  // Chunks of one message have consecutive numbers: that of the first one tells messages apart.
  const PendingKey key{chunk.header.session, chunk.sequence - chunk.index};
  Session& session = heard_of(key.session);
  session.next_sequence = std::max(session.next_sequence, chunk.sequence + 1);
  if (session.seen.contains(chunk.sequence)) {
    ++counts_.chunks_duplicate;
    return {};
  }
  const auto [place, is_first] = session.pending.try_emplace(key.first_sequence);
  Pending& pending = place->second;
  if (is_first) {
    pending.age = clock_;
    pending_by_age_.emplace(clock_, key);
  } else if (pending.chunks.front().identity != chunk.identity) {
    throw DecodeError("chunk " + std::to_string(chunk.sequence) + " of " + channel_ +
                      " has another header than chunk " +
                      std::to_string(pending.chunks.front().sequence) + " of the same message");
  }
  session.seen.insert(chunk.sequence);
  ++counts_.chunks_received;
  const std::size_t bytes = sizeof(chunk) + chunk.part.size() + chunk.identity.size();
  pending.bytes += bytes;
  pending_bytes_ += bytes;
  const auto count = static_cast<std::size_t>(chunk.count);
  pending.chunks.push_back(std::move(chunk));

  std::vector<Chunk<Message>> chunks;
  if (pending.chunks.size() == count) {
    chunks = take(key);
    std::sort(chunks.begin(), chunks.end(),
              [](const auto& a, const auto& b) { return a.index < b.index; });
    ++counts_.messages_complete;
  }
  stay_within_bounds(session);
  return chunks;
}

template <BulkMessage Message>
void StreamSubscriber<Message>::add(const Heartbeat& heartbeat) {
  if (heartbeat.channel != channel_) return;
  const std::lock_guard lock(mutex_);
  ++counts_.heartbeats;
  Session& session = heard_of(heartbeat.session);
  session.first_sequence = std::max(session.first_sequence, heartbeat.first_sequence);
  session.next_sequence = std::max(session.next_sequence, heartbeat.next_sequence);
}

template <BulkMessage Message>
typename StreamSubscriber<Message>::Session& StreamSubscriber<Message>::heard_of(
    std::int64_t session) {
  if (!sessions_.contains(session) && sessions_.size() >= config_.max_sessions) {
    forget_silent_session();
  }
  Session& found = sessions_[session];
  found.last_heard = ++clock_;
  return found;
}

template <BulkMessage Message>
void StreamSubscriber<Message>::forget_silent_session() {
  const auto silent = std::min_element(
      sessions_.begin(), sessions_.end(),
      [](const auto& a, const auto& b) { return a.second.last_heard < b.second.last_heard; });
  while (!silent->second.pending.empty()) {
    const auto chunks = take({silent->first, silent->second.pending.begin()->first});
    counts_.chunks_evicted += static_cast<std::int64_t>(chunks.size());
  }
  sessions_.erase(silent);
}

/// Removes a pending message and returns its chunks.
template <BulkMessage Message>
std::vector<Chunk<Message>> StreamSubscriber<Message>::take(PendingKey key) {
  auto& all = sessions_.at(key.session).pending;
  const auto place = all.find(key.first_sequence);
  std::vector<Chunk<Message>> chunks = std::move(place->second.chunks);
  pending_bytes_ -= place->second.bytes;
  pending_by_age_.erase(place->second.age);
  all.erase(place);
  return chunks;
}

template <BulkMessage Message>
void StreamSubscriber<Message>::stay_within_bounds(Session& session) {
  while (session.seen.num_ranges() > config_.max_gaps_per_session) session.seen.close_lowest_gap();
  while (pending_bytes_ > config_.max_pending_bytes) {
    const PendingKey oldest = pending_by_age_.begin()->second;
    SequenceSet& seen = sessions_.at(oldest.session).seen;
    for (const Chunk<Message>& chunk : take(oldest)) {
      seen.erase(chunk.sequence);
      ++counts_.chunks_evicted;
    }
  }
}

template <BulkMessage Message>
StreamCounts StreamSubscriber<Message>::counts() const {
  const std::lock_guard lock(mutex_);
  StreamCounts counts = counts_;
  for (const auto& [id, session] : sessions_) {
    counts.chunks_missing += session.seen.count_missing(session.next_sequence);
  }
  return counts;
}

template <BulkMessage Message>
std::vector<StreamGap> StreamSubscriber<Message>::gaps() const {
  const std::lock_guard lock(mutex_);
  std::vector<StreamGap> gaps;
  for (const auto& [id, session] : sessions_) {
    auto ranges = session.seen.missing(session.next_sequence, kMaxResendRanges);
    if (ranges.empty()) continue;
    gaps.push_back({id, session.first_sequence, session.next_sequence, std::move(ranges)});
  }
  return gaps;
}

template class StreamSubscriber<CloudSlice>;
template class StreamSubscriber<SegmentUpdate>;
template class StreamSubscriber<RgbdFrameMessage>;
template class StreamSubscriber<Snapshot>;

}  // namespace kintsugi

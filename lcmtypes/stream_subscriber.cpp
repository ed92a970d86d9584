#include "lcmtypes/stream_subscriber.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "lcmtypes/channels.hpp"

namespace kintsugi {
namespace {

// An encoded ResendRequest: everything but the channel's name and the ranges, then each of these.
constexpr std::size_t kRequestBytes = 64;
constexpr std::size_t kRequestRangeBytes = 16;
constexpr std::size_t kMinRequestBytes = kRequestBytes + kMaxStringBytes + kRequestRangeBytes;

// Session numbers kept of those that are over; beyond it the oldest.
constexpr std::size_t kMaxIgnored = 4'096;

void expect_at_least(const char* name, std::size_t value, std::size_t least) {
  if (value >= least) return;
  throw std::invalid_argument(std::string("StreamSubscriber: ") + name + " is " +
                              std::to_string(value) + ", expected at least " +
                              std::to_string(least));
}

}  // namespace

template <BulkMessage Message>
void StreamSubscriberConfig<Message>::validate() const {
  expect_at_least("max_pending_bytes", max_pending_bytes, 1);
  expect_at_least("max_sessions", max_sessions, 1);
  expect_at_least("max_gaps_per_session", max_gaps_per_session, 1);
  expect_at_least("max_request_bytes", max_request_bytes, kMinRequestBytes);
}

template <BulkMessage Message>
StreamSubscriber<Message>::StreamSubscriber(std::string channel, OnMessage on_message, OnBad on_bad,
                                            const Config& config)
    : channel_(std::move(channel)),
      on_message_(std::move(on_message)),
      on_bad_(std::move(on_bad)),
      config_((config.validate(), config)) {}

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
  const StreamRoom room = config_.room ? config_.room() : StreamRoom::kPlenty;
  const bool is_wanted = !config_.wanted || config_.wanted(chunk.header);
  const std::int64_t id = chunk.header.session;
  const std::lock_guard lock(mutex_);
  if (!is_wanted) {
    ++counts_.chunks_unwanted;
    if (sessions_.contains(id)) ignore(id);  // known by a heartbeat that did not name its map
    return {};
  }
  Session* session = heard_of(id);
  if (session != nullptr) session->numbers.note(chunk.sequence);
  if (session == nullptr || session->numbers.has(chunk.sequence)) {
    ++counts_.chunks_duplicate;
    return {};
  }
  if (!session->numbers.takes(chunk.sequence, less_when_full(room), config_.max_gaps_per_session)) {
    ++counts_.chunks_refused;
    return {};
  }
  return collect(*session, std::move(chunk));
}

template <BulkMessage Message>
std::vector<Chunk<Message>> StreamSubscriber<Message>::collect(Session& session,
                                                               Chunk<Message> chunk) {
  // Chunks of one message have consecutive numbers: that of the first one tells messages apart.
  const std::int64_t first_sequence = chunk.sequence - chunk.index;
  Pending& pending = session.pending[first_sequence];
  if (!pending.chunks.empty() && pending.chunks.front().identity != chunk.identity) {
    const std::int64_t other = pending.chunks.front().sequence;
    drop(session, first_sequence);  // one of the two is false; the true ones can be sent again
    throw DecodeError("chunk " + std::to_string(chunk.sequence) + " of " + channel_ +
                      " has another header than chunk " + std::to_string(other) +
                      " of the same message");
  }
  const std::size_t bytes = sizeof(chunk) + chunk.part.size() + chunk.identity.size();
  session.numbers.keep(chunk.sequence, bytes);
  ++counts_.chunks_received;
  pending.bytes += bytes;
  pending_bytes_ += bytes;
  const auto count = static_cast<std::size_t>(chunk.count);
  pending.chunks.push_back(std::move(chunk));
  if (pending.chunks.size() < count) return {};

  ++counts_.messages_complete;
  std::vector<Chunk<Message>> chunks = take(session, first_sequence);
  std::sort(chunks.begin(), chunks.end(),
            [](const auto& a, const auto& b) { return a.index < b.index; });
  return chunks;
}

template <BulkMessage Message>
void StreamSubscriber<Message>::add(const Heartbeat& heartbeat) {
  const bool is_wanted = config_.wanted_map_name.empty() || heartbeat.map_name.empty() ||
                         heartbeat.map_name == config_.wanted_map_name;
  if (heartbeat.channel != channel_ || !is_wanted) return;
  const std::lock_guard lock(mutex_);
  ++counts_.heartbeats;
  Session* session = heard_of(heartbeat.session);
  if (session == nullptr) return;
  session->numbers.hear(heartbeat);
  while (!session->pending.empty() &&
         session->pending.begin()->first < session->numbers.state_sequence()) {
    drop(*session, session->pending.begin()->first);
  }
}

/// The session, a new one if need be; null: it is ignored.
template <BulkMessage Message>
typename StreamSubscriber<Message>::Session* StreamSubscriber<Message>::heard_of(std::int64_t id) {
  if (ignored_.contains(id)) return nullptr;
  if (!sessions_.contains(id) && sessions_.size() >= config_.max_sessions) {
    erase(std::min_element(sessions_.begin(), sessions_.end(), [](const auto& a, const auto& b) {
            const auto worth = [](const Session& session) {
              return std::tuple(session.numbers.chunks_kept(), session.last_heard);
            };
            return worth(a.second) < worth(b.second);
          })->first);
  }
  Session& session = sessions_.try_emplace(id, config_.requests).first->second;
  session.last_heard = ++clock_;
  return &session;
}

template <BulkMessage Message>
void StreamSubscriber<Message>::forget(std::int64_t session) {
  const std::lock_guard lock(mutex_);
  ignore(session);
}

template <BulkMessage Message>
void StreamSubscriber<Message>::ignore(std::int64_t id) {
  erase(id);
  ignored_.insert(id);
  if (ignored_.size() > kMaxIgnored) ignored_.erase(ignored_.begin());
}

template <BulkMessage Message>
void StreamSubscriber<Message>::erase(std::int64_t id) {
  const auto session = sessions_.find(id);
  if (session == sessions_.end()) return;
  for (const auto& [first_sequence, pending] : session->second.pending) {
    pending_bytes_ -= pending.bytes;
  }
  sessions_.erase(session);
}

/// Removes a pending message and returns its chunks.
template <BulkMessage Message>
std::vector<Chunk<Message>> StreamSubscriber<Message>::take(Session& session,
                                                            std::int64_t first_sequence) {
  const auto place = session.pending.find(first_sequence);
  std::vector<Chunk<Message>> chunks = std::move(place->second.chunks);
  pending_bytes_ -= place->second.bytes;
  session.pending.erase(place);
  return chunks;
}

/// As though the chunks of the message had not come.
template <BulkMessage Message>
void StreamSubscriber<Message>::drop(Session& session, std::int64_t first_sequence) {
  for (const Chunk<Message>& chunk : take(session, first_sequence)) {
    session.numbers.drop(chunk.sequence);
  }
}

template <BulkMessage Message>
StreamRoom StreamSubscriber<Message>::less_when_full(StreamRoom room) const {
  const bool is_full = pending_bytes_ > config_.max_pending_bytes;
  return is_full && room == StreamRoom::kPlenty ? StreamRoom::kOnlyNext : room;
}

template <BulkMessage Message>
std::vector<ResendRequest> StreamSubscriber<Message>::poll(double now_s) {
  const StreamRoom room = config_.room ? config_.room() : StreamRoom::kPlenty;
  const std::size_t ranges_per_request =
      std::min(kMaxResendRanges,
               (config_.max_request_bytes - kRequestBytes - channel_.size()) / kRequestRangeBytes);
  std::vector<ResendRequest> requests;
  const std::lock_guard lock(mutex_);
  for (auto& [id, session] : sessions_) {
    const auto ranges = session.numbers.poll(less_when_full(room), config_.max_asked_bytes,
                                             kMaxResendRanges, now_s);
    for (std::size_t from = 0; from < ranges.size(); from += ranges_per_request) {
      ResendRequest& request = requests.emplace_back();
      request.session = id;
      request.channel = channel_;
      request.receiver = config_.receiver;
      const auto first = ranges.begin() + static_cast<std::ptrdiff_t>(from);
      const std::size_t count = std::min(ranges_per_request, ranges.size() - from);
      request.ranges.assign(first, first + static_cast<std::ptrdiff_t>(count));
    }
  }
  counts_.requests_sent += static_cast<std::int64_t>(requests.size());
  return requests;
}

template <BulkMessage Message>
void StreamSubscriber<Message>::ask(Bus& bus, double now_s) {
  for (ResendRequest& request : poll(now_s)) {
    request.utime = wall_clock_us();
    bus.publish(channels::kResendRequest, request);
  }
}

template <BulkMessage Message>
StreamCounts StreamSubscriber<Message>::counts() const {
  const std::lock_guard lock(mutex_);
  StreamCounts counts = counts_;
  for (const auto& [id, session] : sessions_) {
    counts.chunks_missing += session.numbers.count_missing();
    counts.chunks_given_up += session.numbers.count_given_up();
  }
  return counts;
}

template <BulkMessage Message>
std::size_t StreamSubscriber<Message>::pending_bytes() const {
  const std::lock_guard lock(mutex_);
  return pending_bytes_;
}

template <BulkMessage Message>
std::vector<StreamGap> StreamSubscriber<Message>::gaps() const {
  const std::lock_guard lock(mutex_);
  std::vector<StreamGap> gaps;
  for (const auto& [id, session] : sessions_) {
    const StreamSession& numbers = session.numbers;
    if (numbers.is_complete()) continue;
    gaps.push_back({id, numbers.first_sequence(), numbers.next_sequence(), numbers.count_given_up(),
                    numbers.missing(kMaxResendRanges)});
  }
  return gaps;
}

template <BulkMessage Message>
bool StreamSubscriber<Message>::is_complete(std::int64_t session) const {
  const std::lock_guard lock(mutex_);
  const auto known = sessions_.find(session);
  return known != sessions_.end() && known->second.numbers.is_complete();
}

template <BulkMessage Message>
bool StreamSubscriber<Message>::has_given_up(std::int64_t session) const {
  const std::lock_guard lock(mutex_);
  const auto known = sessions_.find(session);
  return known != sessions_.end() && !known->second.numbers.is_complete() &&
         known->second.numbers.count_given_up() == known->second.numbers.count_missing();
}

template class StreamSubscriber<CloudSlice>;
template class StreamSubscriber<SegmentUpdate>;
template class StreamSubscriber<RgbdFrameMessage>;
template class StreamSubscriber<Snapshot>;

}  // namespace kintsugi

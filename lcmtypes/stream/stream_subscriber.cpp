#include "lcmtypes/stream/stream_subscriber.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/channels.hpp"

namespace kintsugi {
namespace {

// Size of an encoded ResendRequest: without the channel's name and the ranges, and of one range.
constexpr std::size_t kRequestBytes = 64;
constexpr std::size_t kRequestRangeBytes = 16;
constexpr std::size_t kMinRequestBytes = kRequestBytes + kMaxStringBytes + kRequestRangeBytes;

void require_at_least(const char* field, std::size_t value, std::size_t least) {
  require(value >= least, std::string("StreamSubscriber: ") + field, value,
          "at least " + std::to_string(least));
}

}  // namespace

template <BulkMessage Message>
void StreamSubscriberConfig<Message>::validate() const {
  require_at_least("max_pending_bytes", max_pending_bytes, 1);
  require_at_least("max_sessions", max_sessions, 1);
  require_at_least("max_gaps_per_session", max_gaps_per_session, 1);
  require_at_least("max_request_bytes", max_request_bytes, kMinRequestBytes);
}

template <BulkMessage Message>
StreamSubscriber<Message>::StreamSubscriber(std::string channel, OnMessage on_message, OnBad on_bad,
                                            const Config& config)
    : channel_(std::move(channel)),
      on_message_(std::move(on_message)),
      on_bad_(std::move(on_bad)),
      config_((config.validate(), config)),
      sessions_(config.requests, config.max_sessions) {}

template <BulkMessage Message>
void StreamSubscriber<Message>::subscribe(Bus& bus) {
  bus.subscribe(channel_, [this](ByteView message) { handle(channel_, message); });
  bus.subscribe(channels::kHeartbeat,
                [this](ByteView message) { handle(channels::kHeartbeat, message); });
  bus.subscribe(channels::kChunksReplaced,
                [this](ByteView message) { handle(channels::kChunksReplaced, message); });
}

template <BulkMessage Message>
bool StreamSubscriber<Message>::handle(const std::string& channel, ByteView message) {
  const bool is_heartbeat = channel == channels::kHeartbeat;
  const bool is_replacement = channel == channels::kChunksReplaced;
  if (!is_heartbeat && !is_replacement && channel != channel_) return false;
  std::optional<Message> complete;
  try {
    if (is_heartbeat) {
      add(decode<Heartbeat>(message));
    } else if (is_replacement) {
      add(decode<ChunksReplaced>(message));
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

/// Keeps the chunk, if it is new and wanted. Returns all chunks of its message if it was the last
/// missing one, else nothing.
template <BulkMessage Message>
std::vector<Chunk<Message>> StreamSubscriber<Message>::add(Chunk<Message> chunk) {
  const StreamRoom room = ask_for_room();
  const bool is_wanted = !config_.wanted || config_.wanted(chunk.header);
  const std::int64_t id = chunk.header.session;
  const std::lock_guard lock(mutex_);
  if (!is_wanted) {
    ++counts_.chunks_unwanted;
    // A heartbeat without a map name may have created the session.
    if (sessions_.find(id) != nullptr) sessions_.end(id);
    return {};
  }
  Session* session = sessions_.heard_of(id);
  if (session != nullptr) session->numbers.note(chunk.sequence);
  if (session == nullptr || session->numbers.has(chunk.sequence)) {
    ++counts_.chunks_duplicate;
    return {};
  }
  if (!kIsResent<Message> && room != StreamRoom::kNone) make_room(*session, chunk);
  if (!session->numbers.takes(chunk.sequence, less_when_full(room), config_.max_gaps_per_session)) {
    ++counts_.chunks_refused;
    return {};
  }
  return keep(*session, std::move(chunk));
}

/// Gives up the oldest of what waits for chunks that nobody sends again, as far as `chunk` of
/// `session` needs its place.
template <BulkMessage Message>
void StreamSubscriber<Message>::make_room(Session& session, const Chunk<Message>& chunk) {
  while (sessions_.pending_bytes() > config_.max_pending_bytes && drop_oldest(session, chunk)) {
    ++counts_.messages_given_up;
  }
  StreamSession& numbers = session.numbers;
  while (!numbers.takes(chunk.sequence, StreamRoom::kPlenty, config_.max_gaps_per_session)) {
    numbers.replace(numbers.missing(1), std::numeric_limits<std::size_t>::max());
  }
}

/// Drops an incomplete message of the session that was silent longest, but not that of `chunk` of
/// `session`. Returns false if there is no other.
template <BulkMessage Message>
bool StreamSubscriber<Message>::drop_oldest(const Session& session, const Chunk<Message>& chunk) {
  Session* oldest = nullptr;
  for (auto& [id, other] : sessions_.all()) {
    if (other.messages.bytes() == 0) continue;
    if (oldest == nullptr || other.last_heard < oldest->last_heard) oldest = &other;
  }
  if (oldest == nullptr) return false;
  std::optional<std::int64_t> kept;
  if (oldest == &session) kept = MessageAssembler<Message>::first_sequence(chunk);
  return oldest->messages.drop_lowest(kept);
}

template <BulkMessage Message>
std::vector<Chunk<Message>> StreamSubscriber<Message>::keep(Session& session,
                                                            Chunk<Message> chunk) {
  if (const auto other = session.messages.conflict(chunk)) {
    // One of the two is false. The true ones can be sent again.
    for (const std::int64_t sequence : session.messages.drop(chunk)) session.numbers.drop(sequence);
    throw DecodeError("chunk " + std::to_string(chunk.sequence) + " of " + channel_ +
                      " has another header than chunk " + std::to_string(*other) +
                      " of the same message");
  }
  session.numbers.keep(chunk.sequence, MessageAssembler<Message>::bytes(chunk));
  ++counts_.chunks_received;
  Chunks complete = session.messages.add(std::move(chunk));
  if (!complete.empty()) ++counts_.messages_complete;
  return complete;
}

template <BulkMessage Message>
void StreamSubscriber<Message>::add(const Heartbeat& heartbeat) {
  if (!is_of_stream(heartbeat.channel, heartbeat.map_name)) return;
  const std::lock_guard lock(mutex_);
  ++counts_.heartbeats;
  Session* session = sessions_.heard_of(heartbeat.session);
  if (session == nullptr) return;
  session->numbers.hear(heartbeat);
  for (const auto sequence : session->messages.drop_before(session->numbers.state_sequence())) {
    session->numbers.drop(sequence);
  }
}

template <BulkMessage Message>
void StreamSubscriber<Message>::add(const ChunksReplaced& replaced) {
  if (!is_of_stream(replaced.channel, replaced.map_name)) return;
  const std::lock_guard lock(mutex_);
  Session* session = sessions_.heard_of(replaced.session);
  if (session == nullptr) return;
  // What came of a message of which the rest does not come any more. Another one may come instead.
  for (const SequenceRange& range : replaced.ranges) {
    for (const auto sequence : session->messages.drop_in(range)) session->numbers.drop(sequence);
  }
  session->numbers.replace(replaced.ranges, config_.max_gaps_per_session);
}

template <BulkMessage Message>
bool StreamSubscriber<Message>::is_of_stream(const std::string& channel,
                                             const std::string& map_name) const {
  const bool is_wanted =
      config_.wanted_map_name.empty() || map_name.empty() || map_name == config_.wanted_map_name;
  return channel == channel_ && is_wanted;
}

template <BulkMessage Message>
void StreamSubscriber<Message>::restore(std::int64_t session,
                                        const std::vector<SequenceRange>& ranges) {
  const std::lock_guard lock(mutex_);
  if (Session* const found = sessions_.heard_of(session)) found->numbers.restore(ranges);
}

template <BulkMessage Message>
void StreamSubscriber<Message>::forget(std::int64_t session) {
  const std::lock_guard lock(mutex_);
  sessions_.end(session);
}

template <BulkMessage Message>
StreamRoom StreamSubscriber<Message>::ask_for_room() const {
  return config_.room ? config_.room() : StreamRoom::kPlenty;
}

template <BulkMessage Message>
StreamRoom StreamSubscriber<Message>::less_when_full(StreamRoom room) const {
  const bool is_full = kIsResent<Message> && sessions_.pending_bytes() > config_.max_pending_bytes;
  return is_full && room == StreamRoom::kPlenty ? StreamRoom::kOnlyNext : room;
}

template <BulkMessage Message>
std::vector<ResendRequest> StreamSubscriber<Message>::poll(double now_s) {
  const StreamRoom room = ask_for_room();
  const std::size_t max_ranges =
      (config_.max_request_bytes - kRequestBytes - channel_.size()) / kRequestRangeBytes;
  ResendRequest request;
  request.channel = channel_;
  request.receiver = config_.receiver;
  std::vector<ResendRequest> requests;
  const std::lock_guard lock(mutex_);
  for (auto& [id, session] : sessions_.all()) {
    const auto ranges = session.numbers.poll(less_when_full(room), config_.max_asked_bytes,
                                             kMaxResendRanges, now_s);
    request.session = id;
    for (std::size_t from = 0; from < ranges.size(); from += max_ranges) {
      const std::size_t to = std::min(from + max_ranges, ranges.size());
      request.ranges.assign(ranges.data() + from, ranges.data() + to);
      requests.push_back(request);
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
  for (const auto& [id, session] : sessions_.all()) {
    counts.chunks_missing += session.numbers.count_missing();
    counts.chunks_given_up += session.numbers.count_given_up();
  }
  return counts;
}

template <BulkMessage Message>
std::size_t StreamSubscriber<Message>::pending_bytes() const {
  const std::lock_guard lock(mutex_);
  return sessions_.pending_bytes();
}

template <BulkMessage Message>
std::vector<StreamGap> StreamSubscriber<Message>::gaps() const {
  const std::lock_guard lock(mutex_);
  std::vector<StreamGap> gaps;
  for (const auto& [id, session] : sessions_.all()) {
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
  const Session* known = sessions_.find(session);
  return known != nullptr && known->numbers.is_complete();
}

template <BulkMessage Message>
bool StreamSubscriber<Message>::has_given_up(std::int64_t session) const {
  const std::lock_guard lock(mutex_);
  const Session* known = sessions_.find(session);
  return known != nullptr && known->numbers.has_given_up();
}

template class StreamSubscriber<CloudSlice>;
template class StreamSubscriber<SegmentUpdate>;
template class StreamSubscriber<SegmentAnswer>;
template class StreamSubscriber<RgbdFrameMessage>;
template class StreamSubscriber<CameraView>;
template class StreamSubscriber<KeyframeMessage>;
template class StreamSubscriber<Snapshot>;

}  // namespace kintsugi

#pragma once
// Receives a numbered stream of bulk messages, from the bus or from a log.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/stream/stream_sessions.hpp"

namespace kintsugi {

/// What a receiver has counted, over all sessions.
struct StreamCounts {
  std::int64_t chunks_received = 0;  ///< valid and new
  std::int64_t chunks_duplicate =
      0;  ///< received before, replaced by a full state, or of a forgotten session: dropped
  std::int64_t chunks_missing = 0;   ///< at present: known to exist, not received
  std::int64_t chunks_given_up = 0;  ///< of these: the sender does not answer
  std::int64_t chunks_refused = 0;   ///< dropped for lack of memory, requested again later
  std::int64_t chunks_unwanted = 0;  ///< of sessions that are not wanted
  std::int64_t messages_bad = 0;     ///< not decoded, or in conflict with other chunks
  std::int64_t messages_complete = 0;
  /// Incomplete ones that were dropped for lack of memory, because nobody sends the rest again.
  std::int64_t messages_given_up = 0;
  std::int64_t heartbeats = 0;
  std::int64_t requests_sent = 0;
};

/// The missing chunks of one session of a stream.
struct StreamGap {
  std::int64_t session = 0;
  std::int64_t first_sequence = 0;    ///< the oldest that the sender can still resend
  std::int64_t next_sequence = 0;     ///< one past the newest known to exist
  std::int64_t chunks_given_up = 0;   ///< of the missing ones: the sender does not answer
  std::vector<SequenceRange> ranges;  ///< lowest first, at most kMaxResendRanges
};

/// Whether chunks are sent again on request: of the other messages the sender keeps none.
template <BulkMessage Message>
inline constexpr bool kIsResent =
    std::same_as<Message, CloudSlice> || std::same_as<Message, SegmentUpdate> ||
    std::same_as<Message, KeyframeMessage>;

template <BulkMessage Message>
struct StreamSubscriberConfig {
  /// Memory of incomplete messages. Beyond it only the missing chunks with the lowest numbers of a
  /// session are kept, the others are requested again later. Where nothing is sent again, the
  /// oldest incomplete message is dropped instead. So the memory is bounded by this and the size of
  /// one message.
  std::size_t max_pending_bytes =
      kIsResent<Message> ? std::size_t{1} << 30U : std::size_t{1} << 24U;
  std::size_t max_sessions = 64;  ///< beyond it the one with the fewest chunks is dropped
  /// Beyond it a chunk that would create another gap is not kept, but requested again later. Where
  /// nothing is sent again, the lowest gap is no longer waited for instead.
  std::size_t max_gaps_per_session = 65'536;

  ResendRequests::Config requests;
  std::size_t max_request_bytes = 1'400;  ///< of one request, which should fit one datagram
  /// About so many bytes are requested at a time, so that other receivers are answered soon, too,
  /// and little is resent for nothing if this receiver ends.
  std::int64_t max_asked_bytes = 2'000'000;
  std::int64_t receiver = 0;  ///< number of this process in its requests

  /// How much memory the caller has for further messages. Called for every chunk, without a lock.
  /// Empty: kPlenty.
  std::function<StreamRoom()> room;
  /// Whether the caller wants the session of a message with this header, which has no bulk data. It
  /// must give the same answer for all messages of a session. Called for every chunk, without a
  /// lock. Empty: all sessions are wanted.
  std::function<bool(const Message& header)> wanted;
  /// Heartbeats of other maps are ignored. Empty: none are.
  std::string wanted_map_name;

  /// @throws std::invalid_argument naming the field that is out of its bounds
  void validate() const;
};

/// Joins the chunks of one channel to messages, in each session for itself, and requests missing
/// chunks. Chunks may arrive in any order and repeatedly; the messages that result depend only on
/// what was published. Memory is bounded (see max_pending_bytes).
///
/// Only one thread may call handle() and poll(); any thread may call the other functions.
/// `on_message` is called once with each message, when its last chunk arrives; a slice that is sent
/// again with a higher revision is another message. `on_bad` (may be empty) is called with the
/// reason whenever a message or chunk is dropped as invalid.
template <BulkMessage Message>
class StreamSubscriber {
 public:
  using Config = StreamSubscriberConfig<Message>;
  using OnMessage = std::function<void(Message message)>;
  using OnBad = std::function<void(const DecodeError& reason)>;

  StreamSubscriber(std::string channel, OnMessage on_message, OnBad on_bad = {},
                   const Config& config = {});

  /// From now on bus.handle() passes messages of the channel, heartbeats and what is told of
  /// replaced chunks to handle(). This must outlive the last bus.handle().
  void subscribe(Bus& bus);

  /// Handles one LCM message, for instance of a log. Returns true if it is on the stream's channel,
  /// a heartbeat, or tells of replaced chunks. Invalid messages are counted; only the callbacks may
  /// throw.
  bool handle(const std::string& channel, ByteView message);

  /// The requests to send now on RESEND_REQUEST. To be called regularly, for instance in the tick
  /// of a BusThread; not when a log is read. `now_s` is the time of a PatientClock.
  std::vector<ResendRequest> poll(double now_s);
  /// Sends the requests of poll().
  void ask(Bus& bus, double now_s);

  StreamCounts counts() const;
  std::size_t pending_bytes() const;  ///< of incomplete messages
  /// The sessions with missing chunks.
  std::vector<StreamGap> gaps() const;
  /// No chunk that is known to exist of the session is missing; false if the session is unknown.
  /// The last chunks of its newest message may not be known yet.
  bool is_complete(std::int64_t session) const;
  /// Chunks of the session are missing, and all of them have been given up for now.
  bool has_given_up(std::int64_t session) const;

  /// Declares chunks as received by an earlier run of this receiver: they are not requested.
  void restore(std::int64_t session, const std::vector<SequenceRange>& ranges);

  /// Ignores the session from now on: its memory is freed, and its chunks count as duplicates.
  void forget(std::int64_t session);

 private:
  using Session = typename StreamSessions<Message>::Session;
  using Chunks = std::vector<Chunk<Message>>;

  Chunks add(Chunk<Message> chunk);
  void add(const Heartbeat& heartbeat);
  void add(const ChunksReplaced& replaced);
  bool is_of_stream(const std::string& channel, const std::string& map_name) const;
  StreamRoom ask_for_room() const;
  // With the lock held:
  void make_room(Session& session, const Chunk<Message>& chunk);
  bool drop_oldest(const Session& session, const Chunk<Message>& chunk);
  Chunks keep(Session& session, Chunk<Message> chunk);
  StreamRoom less_when_full(StreamRoom room) const;

  const std::string channel_;
  const OnMessage on_message_;
  const OnBad on_bad_;
  const Config config_;

  mutable std::mutex mutex_;  // guards what follows; not held in callbacks
  StreamSessions<Message> sessions_;
  StreamCounts counts_;
};

}  // namespace kintsugi

#pragma once
// Complete bulk messages out of the chunks of a numbered stream, live or from a log.

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

struct StreamCounts {
  std::int64_t chunks_received = 0;   ///< valid and new
  std::int64_t chunks_duplicate = 0;  ///< seen before, superseded or forgotten: dropped
  std::int64_t chunks_missing = 0;    ///< known to exist and not there, now
  std::int64_t chunks_given_up = 0;   ///< of the missing ones: nobody answers, now
  std::int64_t chunks_refused = 0;    ///< no room for them; they come again when there is
  std::int64_t chunks_unwanted = 0;   ///< of sessions that are not wanted
  std::int64_t messages_bad = 0;      ///< did not decode, or did not fit their neighbours
  std::int64_t messages_complete = 0;
  std::int64_t heartbeats = 0;
  std::int64_t requests_sent = 0;
};

/// What is missing of one session of a stream.
struct StreamGap {
  std::int64_t session = 0;
  std::int64_t first_sequence = 0;    ///< the oldest that the sender can still resend
  std::int64_t next_sequence = 0;     ///< one past the newest known to exist
  std::int64_t chunks_given_up = 0;   ///< nobody answers for so many of them
  std::vector<SequenceRange> ranges;  ///< lowest first, at most kMaxResendRanges
};

template <BulkMessage Message>
struct StreamSubscriberConfig {
  /// Chunks of incomplete messages, bytes. Beyond it only what is missing lowest in a session is
  /// taken; the rest is asked for again later. So memory is this and one message.
  std::size_t max_pending_bytes = std::size_t{1} << 30U;
  std::size_t max_sessions = 64;  ///< beyond it the one with the fewest chunks is forgotten
  /// Beyond it no chunk is taken that opens another gap: it is asked for again later.
  std::size_t max_gaps_per_session = 65'536;

  ResendRequests::Config requests;
  std::size_t max_request_bytes = 1'400;  ///< of one request, which should fit one datagram
  /// Asked for at a time, about. So others are answered soon too, and little is sent in vain when
  /// this receiver goes away.
  std::int64_t max_asked_bytes = 2'000'000;
  std::int64_t receiver = 0;  ///< number of this process, said in its requests

  /// How much the caller can take now; called for every chunk, without a lock. Empty: kPlenty.
  std::function<StreamRoom()> room;
  /// Whether the session of a message with this header (no bulk data) is wanted; all headers of a
  /// session give the same answer. Called for every chunk, without a lock. Empty: all are.
  std::function<bool(const Message& header)> wanted;
  /// A session whose heartbeats name another map is ignored. Empty: none is.
  std::string wanted_map_name;

  void validate() const;
};

/// Puts the chunks of one channel together, per session; no matter in which order, how often or
/// between which others they come; and says what to ask for again. Memory holds only what arrived,
/// up to a bound.
///
/// handle() and poll() belong to one thread; the rest may be called from any. `on_message` gets
/// each message once, when its last chunk arrives; a slice that is sent again with a higher
/// revision is another message. `on_bad` (may be empty) gets the reason why something was dropped.
/// What a receiver ends up with depends on nothing but what was published.
template <BulkMessage Message>
class StreamSubscriber {
 public:
  using Config = StreamSubscriberConfig<Message>;
  using OnMessage = std::function<void(Message message)>;
  using OnBad = std::function<void(const DecodeError& reason)>;

  StreamSubscriber(std::string channel, OnMessage on_message, OnBad on_bad = {},
                   const Config& config = {});

  /// Subscribes to the channel and the heartbeats of `bus`; this must outlive bus.handle().
  void subscribe(Bus& bus);

  /// One LCM message, from a log for instance; true when it was on the stream's channel or a
  /// heartbeat. Whatever is in it, only the callbacks may throw.
  bool handle(const std::string& channel, ByteView message);

  /// What to ask for now, each to be sent on RESEND_REQUEST; for a BusThread's tick, whether or not
  /// something came. `now_s` is a PatientClock's. A reader of a log does not call it.
  std::vector<ResendRequest> poll(double now_s);
  /// Sends what poll() gives.
  void ask(Bus& bus, double now_s);

  StreamCounts counts() const;
  std::size_t pending_bytes() const;  ///< of incomplete messages
  /// The sessions with something missing.
  std::vector<StreamGap> gaps() const;
  /// Nothing that is known to exist of the session is missing; false when nothing is known of it.
  /// Of its newest message the last chunks may be still to come.
  bool is_complete(std::int64_t session) const;
  /// Something of the session is missing, and all of it has been given up for now.
  bool has_given_up(std::int64_t session) const;

  /// What an earlier run of this receiver has of the session: it is not missing, and does not come
  /// again.
  void restore(std::int64_t session, const std::vector<SequenceRange>& ranges);

  /// Nothing more of the session is wanted: its memory is freed, what comes of it counts as
  /// duplicate.
  void forget(std::int64_t session);

 private:
  using Session = typename StreamSessions<Message>::Session;
  using Chunks = std::vector<Chunk<Message>>;

  Chunks add(Chunk<Message> chunk);
  void add(const Heartbeat& heartbeat);
  StreamRoom ask_for_room() const;
  // With the lock held:
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

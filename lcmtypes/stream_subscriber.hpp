#pragma once
// Complete bulk messages out of the chunks of a numbered stream, live or from a log.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "lcmtypes/bus.hpp"
#include "lcmtypes/codec.hpp"
#include "lcmtypes/sequence_set.hpp"

namespace kintsugi {

struct StreamCounts {
  std::int64_t chunks_received = 0;   ///< valid and new
  std::int64_t chunks_duplicate = 0;  ///< seen before, dropped
  std::int64_t chunks_missing = 0;    ///< known to exist and not there, now
  std::int64_t chunks_evicted = 0;    ///< dropped again to stay within the memory bound
  std::int64_t messages_bad = 0;      ///< did not decode, or did not fit their neighbours
  std::int64_t messages_complete = 0;
  std::int64_t heartbeats = 0;
};

/// What is missing of one session of a stream.
struct StreamGap {
  std::int64_t session = 0;
  std::int64_t first_sequence = 0;    ///< the oldest that the sender can still resend
  std::int64_t next_sequence = 0;     ///< one past the newest known to exist
  std::vector<SequenceRange> ranges;  ///< lowest first, at most kMaxResendRanges
};

struct StreamSubscriberConfig {
  /// Chunks of incomplete messages, bytes; beyond it the oldest incomplete message is dropped and
  /// its chunks count as missing.
  std::size_t max_pending_bytes = std::size_t{1} << 30U;
  std::size_t max_sessions = 64;              ///< beyond it the one longest silent is forgotten
  std::size_t max_gaps_per_session = 65'536;  ///< beyond it the oldest gap is given up

  void validate() const;
};

/// Puts the chunks of one channel together, per session; no matter in which order, how often or
/// between which others they come. Memory holds only what arrived, up to a bound.
///
/// handle() belongs to one thread; counts() and gaps() may be called from any. `on_message` gets
/// each message once, when its last chunk arrives; a slice that is sent again with a higher
/// revision is another message. `on_bad` (may be empty) gets the reason why something was dropped.
template <BulkMessage Message>
class StreamSubscriber {
 public:
  using Config = StreamSubscriberConfig;
  using OnMessage = std::function<void(Message message)>;
  using OnBad = std::function<void(const DecodeError& reason)>;

  StreamSubscriber(std::string channel, OnMessage on_message, OnBad on_bad = {},
                   const Config& config = {});

  /// Subscribes to the channel and the heartbeats of `bus`; this must outlive bus.handle().
  void subscribe(Bus& bus);

  /// One LCM message, from a log for instance; true when it was on the stream's channel or a
  /// heartbeat. Whatever is in it, only the callbacks may throw.
  bool handle(const std::string& channel, ByteView message);

  StreamCounts counts() const;
  /// The sessions with something missing. Nobody is asked for it here.
  std::vector<StreamGap> gaps() const;

 private:
  struct Pending {
    std::vector<Chunk<Message>> chunks;  // as they came
    std::size_t bytes = 0;
    std::int64_t age = 0;  // when its first chunk came
  };
  struct Session {
    SequenceSet seen;
    std::int64_t first_sequence = 0;
    std::int64_t next_sequence = 0;
    std::int64_t last_heard = 0;
    std::map<std::int64_t, Pending> pending;  // by the sequence number of the message's chunk 0
  };
  struct PendingKey {
    std::int64_t session = 0;
    std::int64_t first_sequence = 0;
  };

  std::vector<Chunk<Message>> add(Chunk<Message> chunk);
  void add(const Heartbeat& heartbeat);
  // With the lock held:
  Session& heard_of(std::int64_t session);
  void forget_silent_session();
  std::vector<Chunk<Message>> take(PendingKey key);
  void stay_within_bounds(Session& session);

  const std::string channel_;
  const OnMessage on_message_;
  const OnBad on_bad_;
  const Config config_;

  mutable std::mutex mutex_;  // guards what follows; not held in callbacks
  std::map<std::int64_t, Session> sessions_;
  std::map<std::int64_t, PendingKey> pending_by_age_;
  std::size_t pending_bytes_ = 0;
  std::int64_t clock_ = 0;  // counts messages
  StreamCounts counts_;
};

}  // namespace kintsugi

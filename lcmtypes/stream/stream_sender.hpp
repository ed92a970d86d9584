#pragma once
// The logic of StreamPublisher, without its thread and its clock.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "lcmtypes/stream/resend_queue.hpp"
#include "lcmtypes/stream/sent_store.hpp"
#include "lcmtypes/stream/token_bucket.hpp"

namespace kintsugi {

struct StreamPublisherConfig {
  /// Of new data and resends together, > 0. A small message counts as one of 8,000 bytes, so that
  /// many of them are slowed down, too.
  double rate_bytes_per_s = 10e6;
  /// Bytes that may be sent at once after a pause. By default two datagrams: a receive buffer of
  /// the kernel's default size holds three.
  std::size_t burst_bytes = 120'000;
  /// Largest LCM message, bytes: Bus::max_message_bytes().
  std::size_t max_chunk_bytes = kDefaultMaxChunkBytes;
  std::chrono::milliseconds heartbeat_period{200};  ///< > 0
  std::string map_name;  ///< of the map that the stream carries; empty: several maps
  /// Called at each request for a chunk that is no longer in the store and that no full state
  /// replaces, from the publisher's thread: it must not block. The owner then publishes a full
  /// state. May be empty.
  std::function<void()> on_state_wanted;

  /// @throws std::invalid_argument naming the field that is out of its bounds
  void validate() const;
};

struct StreamPublisherCounts {
  std::int64_t chunks_sent = 0;      ///< new ones
  std::int64_t bytes_sent = 0;       ///< of new chunks
  std::int64_t chunks_compared = 0;  ///< of a resumed session: equal to the store, not sent again
  std::int64_t chunks_resent = 0;    ///< on request
  std::int64_t bytes_resent = 0;
  std::int64_t messages_superseded = 0;  ///< while they waited to be sent
  std::int64_t requests_received = 0;    ///< for this session and channel
  std::int64_t requests_bad = 0;         ///< not decoded
};

/// Sends the chunks of queued messages in order, resends requested chunks or tells that they are
/// replaced, and sends heartbeats that tell which chunks exist; one token bucket limits the rate of
/// all. A chunk is in the store before it is sent, and safe there; chunks of one second are stored
/// ahead while the store needs time for that. Only one thread may use it. Time is an argument:
/// seconds that never decrease.
class StreamSender {
 public:
  using Config = StreamPublisherConfig;
  using Transmit = std::function<void(const std::string& channel, ByteView message)>;

  /// A message to send.
  struct Job {
    std::int32_t num_chunks = 0;
    std::size_t bytes = 0;
    bool starts_state = false;  ///< a full state starts here: no earlier chunk is needed
    std::function<Bytes(std::int64_t sequence, std::int32_t index)> encode;
    /// What the message is about: while it waits, a later one with this key supersedes it.
    std::optional<std::int64_t> key;
    /// The chunk that is sent in its place when it is superseded.
    std::function<Bytes(std::int64_t sequence)> encode_superseded;
  };

  /// @param store may be null: then nothing can be resent
  StreamSender(Transmit transmit, std::string channel, std::int64_t session, const Config& config,
               SentStore* store);

  void push(Job job);
  void request(const ResendRequest& request, double now_s);
  /// Sends a heartbeat as soon as everything is sent, unless the last one has announced that
  /// already.
  void announce() { announce_ = true; }

  /// Does what is due next, and sends at most one message. Returns the seconds after which it must
  /// be called again.
  /// @throws what `transmit` throws, and std::runtime_error when a chunk of a resumed session
  /// differs
  ///   from the one in the store
  double step(double now_s);

  /// Everything that was pushed and a heartbeat after it have been sent.
  bool is_done() const { return !has_new_chunks() && announced_ == next_sequence(); }
  /// One past the newest chunk that was sent, in this run or an earlier one of the session.
  std::int64_t next_sequence() const;
  std::size_t queued_bytes() const { return queued_bytes_; }
  const StreamPublisherCounts& counts() const { return counts_; }

 private:
  struct Next {  // a chunk that waits to be sent
    std::int64_t sequence = 0;
    bool is_resend = false;
    Bytes chunk;
    bool starts_state = false;
    std::size_t job_bytes = 0;  // of the message, if this is its last chunk
  };

  std::int64_t first_sequence() const;
  bool has_new_chunks() const;
  bool waits_for_store() const;
  Bytes encode_next() const;
  void supersede(std::int64_t key);
  void compare_with_store();
  void prepare();
  void note_replaced(const std::vector<SequenceRange>& asked);
  void send_replaced(double now_s);
  double wait_for_tokens(double cost, double now_s);
  void store_ahead();
  void store_next();
  void send_prepared(double now_s);
  std::size_t advance();
  void send_heartbeat(double now_s);

  const Transmit transmit_;
  const std::string channel_;
  const std::int64_t session_;
  const Config config_;
  SentStore* const store_;
  const std::int64_t resumed_end_;  // chunks below were sent by an earlier run of the session

  TokenBucket bucket_;
  ResendQueue resends_;
  std::deque<Job> jobs_;
  std::int32_t next_index_ = 0;   // of the chunk of the first job
  std::deque<Next> stored_;       // of earlier jobs or chunks
  std::size_t stored_bytes_ = 0;  // of their chunks
  std::optional<Next> prepared_;  // waits for the token bucket
  std::size_t queued_bytes_ = 0;
  std::int64_t sequence_ = 0;  // of the next chunk of the jobs
  std::int64_t sent_end_ = 0;  // one past the last chunk that was sent or compared
  std::int64_t state_sequence_ = 0;
  std::int64_t announced_ = -1;  // next_sequence of the last heartbeat
  double next_heartbeat_s_ = 0.0;
  std::optional<std::int64_t> replaced_;  // the lowest chunk that was asked for and is replaced
  double next_replaced_s_ = 0.0;          // when that may be told
  const double min_wait_s_;
  bool announce_ = false;
  StreamPublisherCounts counts_;
};

}  // namespace kintsugi

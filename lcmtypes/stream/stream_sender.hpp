#pragma once
// What a StreamPublisher does, without its thread and its clock.

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
  double rate_bytes_per_s = 10e6;  ///< of new data and resends together, > 0
  /// Sent at once after a pause, bytes. Two datagrams: a stock receive buffer holds three.
  std::size_t burst_bytes = 120'000;
  /// Largest LCM message, bytes: Bus::max_message_bytes().
  std::size_t max_chunk_bytes = kDefaultMaxChunkBytes;
  std::chrono::milliseconds heartbeat_period{200};  ///< > 0
  std::string map_name;  ///< of the map that the stream is about; empty: several
  /// Called when somebody asks for a chunk that the store has no more and no full state has
  /// superseded; as often as it is asked for, from the publisher's thread: must not block. May be
  /// empty.
  std::function<void()> on_state_wanted;

  void validate() const;
};

struct StreamPublisherCounts {
  std::int64_t chunks_sent = 0;      ///< new ones
  std::int64_t bytes_sent = 0;       ///< of new chunks
  std::int64_t chunks_compared = 0;  ///< made again, found in the store, not sent again
  std::int64_t chunks_resent = 0;    ///< because somebody asked
  std::int64_t bytes_resent = 0;
  std::int64_t requests_received = 0;  ///< for this session and channel
  std::int64_t requests_bad = 0;       ///< did not decode
};

/// Sends the chunks of queued messages in order, resends what is asked for, and says with
/// heartbeats what exists; under one token bucket. Belongs to one thread, and time is an argument:
/// seconds that never decrease.
class StreamSender {
 public:
  using Config = StreamPublisherConfig;
  using Transmit = std::function<void(const std::string& channel, ByteView message)>;

  /// A message to send.
  struct Job {
    std::int32_t num_chunks = 0;
    std::size_t bytes = 0;
    bool starts_state = false;  ///< a receiver that has everything from here on lacks nothing
    std::function<Bytes(std::int64_t sequence, std::int32_t index)> encode;
  };

  /// `store` may be null: nothing can be resent.
  StreamSender(Transmit transmit, std::string channel, std::int64_t session, const Config& config,
               SentStore* store);

  void push(Job job);
  void request(const ResendRequest& request, double now_s);
  /// A heartbeat at once when everything is sent, unless the last one has said so.
  void announce() { announce_ = true; }

  /// Does the next thing that is due, at most one message; returns the seconds until it should be
  /// called again, at the latest. Throws what transmit threw, and std::runtime_error when a chunk
  /// made again differs from the stored one.
  double step(double now_s);

  /// Everything pushed has been sent, and a heartbeat after it.
  bool is_done() const { return jobs_.empty() && announced_ == next_sequence(); }
  /// One past the newest chunk sent, in this run or an earlier one of the session.
  std::int64_t next_sequence() const;
  std::size_t queued_bytes() const { return queued_bytes_; }
  const StreamPublisherCounts& counts() const { return counts_; }

 private:
  struct Next {  // what waits for the token bucket
    std::int64_t sequence = 0;
    bool is_resend = false;
    Bytes chunk;
  };

  std::int64_t first_sequence() const;
  Bytes encode_next() const;
  void compare_with_store();
  void prepare();
  void send_prepared(double now_s);
  void finish_chunk();
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
  std::int32_t next_index_ = 0;  // of the chunk of the first job
  std::optional<Next> prepared_;
  std::size_t queued_bytes_ = 0;
  std::int64_t sequence_ = 0;  // of the next chunk of the jobs
  std::int64_t state_sequence_ = 0;
  std::int64_t announced_ = -1;  // next_sequence of the last heartbeat
  double next_heartbeat_s_ = 0.0;
  const double min_wait_s_;
  bool announce_ = false;
  StreamPublisherCounts counts_;
};

}  // namespace kintsugi

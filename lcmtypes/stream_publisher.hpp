#pragma once
// A numbered stream of bulk messages onto the bus, paced so that a stock receive buffer keeps up.

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "lcmtypes/bus.hpp"
#include "lcmtypes/codec.hpp"
#include "lcmtypes/token_bucket.hpp"

namespace kintsugi {

/// Keeps what a stream has sent, for those who missed it.
class SentStore {
 public:
  virtual ~SentStore() = default;
  /// Called for every chunk before it is sent, in order of `sequence`, from the pacing thread.
  virtual void add(std::int64_t sequence, ByteView message) = 0;
  /// The oldest sequence number that can still be sent again; one past the newest: none.
  virtual std::int64_t first_sequence() const = 0;
};

/// Publishes bulk messages of one type on one channel as chunks with consecutive sequence numbers
/// from 0, under a token bucket, and heartbeats that say how far the stream has come.
///
/// publish() only queues; a thread of the publisher encodes and sends chunk by chunk, so that
/// memory is that of the queued messages: a caller that outruns the bucket watches queued_bytes().
class StreamPublisher {
 public:
  struct Config {
    double rate_bytes_per_s = 10e6;  ///< > 0
    /// Sent at once after a pause, bytes. Two datagrams: a stock receive buffer holds three.
    std::size_t burst_bytes = 120'000;
    std::size_t max_chunk_bytes = kDefaultMaxChunkBytes;  ///< largest LCM message, bytes
    std::chrono::milliseconds heartbeat_period{200};      ///< > 0

    void validate() const;
  };
  using Transmit = std::function<void(const std::string& channel, ByteView message)>;

  /// Publishes on `bus`, which must outlive this. `store` may be null.
  StreamPublisher(Bus& bus, std::string channel, std::int64_t session, const Config& config,
                  SentStore* store = nullptr);
  /// Hands what it sends to `transmit`, called from one thread: a log, a test.
  StreamPublisher(Transmit transmit, std::string channel, std::int64_t session,
                  const Config& config, SentStore* store = nullptr);
  /// Sends what is queued, unless sending has failed.
  ~StreamPublisher();
  StreamPublisher(const StreamPublisher&) = delete;
  StreamPublisher& operator=(const StreamPublisher&) = delete;

  /// Queues `message`. Throws std::invalid_argument when a field is out of its bounds or its
  /// session is another, and what sending threw when it has failed.
  template <BulkMessage Message>
  void publish(Message message);

  /// Waits until everything queued is sent, and a heartbeat after it. Throws what sending threw.
  void flush();

  std::int64_t chunks_published() const;  ///< also the next sequence number
  std::size_t queued_bytes() const;       ///< of messages not yet sent in full

 private:
  struct Job {
    std::int32_t num_chunks = 0;
    std::size_t bytes = 0;
    std::function<Bytes(std::int64_t sequence, std::int32_t index)> encode;
  };

  void enqueue(Job job);
  // The thread. What takes the lock gives it up while it encodes, waits and sends.
  void run();
  void send_message(std::unique_lock<std::mutex>& lock);
  void send_heartbeat(std::unique_lock<std::mutex>& lock);
  void pace(std::size_t bytes);
  bool heartbeat_is_due() const;

  const Transmit transmit_;
  const std::string channel_;
  const std::int64_t session_;
  const Config config_;
  SentStore* const store_;
  TokenBucket bucket_;  // this and the next are used by the thread alone
  std::chrono::steady_clock::time_point next_heartbeat_ = std::chrono::steady_clock::now();
  const std::chrono::steady_clock::time_point start_ = next_heartbeat_;

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable wake_;
  std::condition_variable idle_;
  std::deque<Job> queue_;
  std::size_t queued_bytes_ = 0;
  std::int64_t next_sequence_ = 0;
  std::int64_t heartbeat_sequence_ = -1;  // the next_sequence of the last heartbeat
  int num_flushing_ = 0;                  // callers of flush() that wait
  bool stopping_ = false;
  std::exception_ptr failure_;

  std::thread thread_;
};

}  // namespace kintsugi

#pragma once
// A numbered stream of bulk messages onto the bus, paced so that a stock receive buffer keeps up,
// with resends for who asks.

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/stream/stream_sender.hpp"

namespace kintsugi {

/// Publishes bulk messages of one type on one channel as chunks with consecutive sequence numbers
/// from 0, under a token bucket; keeps them in a store, from which it resends what is asked for;
/// says with heartbeats how far the stream has come.
///
/// publish() only queues; a thread of the publisher encodes and sends chunk by chunk, so that
/// memory is that of the queued messages: a caller that outruns the bucket watches queued_bytes().
///
/// With a store that holds chunks of the session already, the session goes on: the messages must be
/// published again from its first one on. Chunks that the store has are compared with it instead of
/// sent; one that differs is an error. Without any publish() the earlier session is served.
class StreamPublisher {
 public:
  using Config = StreamPublisherConfig;
  using Transmit = StreamSender::Transmit;

  /// Publishes on `bus`; it and `store` (may be null: no resends) must outlive this.
  StreamPublisher(Bus& bus, std::string channel, std::int64_t session, const Config& config,
                  SentStore* store = nullptr);
  /// Hands what it sends to `transmit`, called from one thread: a log, a test.
  StreamPublisher(Transmit transmit, std::string channel, std::int64_t session,
                  const Config& config, SentStore* store = nullptr);
  /// Sends what is queued, unless sending has failed; resends nothing more.
  ~StreamPublisher();
  StreamPublisher(const StreamPublisher&) = delete;
  StreamPublisher& operator=(const StreamPublisher&) = delete;

  /// Queues `message`. Throws std::invalid_argument when a field is out of its bounds or its
  /// session is another, and what sending threw when it has failed.
  template <BulkMessage Message>
  void publish(Message message);

  /// Publishes messages that together say everything: a receiver that has them and what comes after
  /// lacks nothing, and need not ask for what went before. As publish(); not empty.
  template <BulkMessage Message>
  void publish_state(std::vector<Message> messages);

  /// Somebody asks for chunks; false when they are not of this session and channel.
  bool request(const ResendRequest& request);
  /// From now on answers what is asked on `bus`; this must outlive bus.handle().
  void subscribe(Bus& bus);

  /// Waits until everything queued is sent, and a heartbeat after it. Throws what sending threw.
  void flush();

  std::int64_t chunks_published() const;  ///< also the next sequence number
  std::size_t queued_bytes() const;       ///< of messages not yet sent in full
  StreamPublisherCounts counts() const;
  /// Since somebody last asked for something, or since the start when nobody has. Seconds in which
  /// a stopped process does not age.
  double time_since_request_s() const;

 private:
  template <BulkMessage Message>
  StreamSender::Job job_of(Message message) const;
  void enqueue(std::vector<StreamSender::Job> jobs);
  void run();
  // With the lock held:
  std::vector<ResendRequest> hand_over(double now_s);
  void note_progress(double now_s);

  const std::string channel_;
  const std::int64_t session_;
  const std::size_t max_chunk_bytes_;
  PatientClock clock_;
  StreamSender sender_;  // of the thread alone

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable wake_;
  std::condition_variable done_;
  std::vector<StreamSender::Job> new_jobs_;  // for the thread, as the requests
  std::vector<ResendRequest> new_requests_;
  std::size_t new_bytes_ = 0;  // of new_jobs_
  bool has_news_ = false;      // the thread should look
  int num_flushing_ = 0;       // callers of flush() that wait
  bool stopping_ = false;
  std::exception_ptr failure_;
  bool sender_is_done_ = false;  // these say what the thread has last seen of sender_
  std::int64_t next_sequence_ = 0;
  std::size_t queued_bytes_ = 0;
  StreamPublisherCounts counts_;
  std::int64_t requests_bad_ = 0;
  double last_request_s_ = 0.0;
  double now_s_ = 0.0;

  std::thread thread_;
};

}  // namespace kintsugi

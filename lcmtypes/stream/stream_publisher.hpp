#pragma once
// Publishes a numbered stream of bulk messages. The rate is limited, so that receive buffers of the
// default size do not overflow, and chunks are resent to receivers that request them.

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/stream/stream_sender.hpp"

namespace kintsugi {

/// Publishes bulk messages of one type on one channel, as chunks with consecutive sequence numbers
/// from 0. A token bucket limits the rate. Chunks are kept in a store, from which requested ones
/// are resent. Heartbeats tell receivers which chunks exist.
///
/// publish() only queues the message; a thread of the publisher encodes and sends it chunk by
/// chunk. The queue has no limit: a caller that may publish faster than the bucket must watch
/// queued_bytes().
///
/// If the store already has chunks of the session, the publisher resumes the session: the caller
/// must publish all its messages again from the first one on. Chunks that are in the store are
/// compared with it instead of sent; a difference is an error. Until the first publish(), the
/// publisher only resends chunks from the store.
class StreamPublisher {
 public:
  using Config = StreamPublisherConfig;
  using Transmit = StreamSender::Transmit;

  /// Publishes on `bus`. `bus` and `store` must outlive this; without a store nothing is resent.
  StreamPublisher(Bus& bus, std::string channel, std::int64_t session, const Config& config,
                  SentStore* store = nullptr);
  /// Calls `transmit` with every message to send, from one thread; for a log or a test.
  StreamPublisher(Transmit transmit, std::string channel, std::int64_t session,
                  const Config& config, SentStore* store = nullptr);
  /// Sends what is queued, unless sending has failed. Nothing is resent any more.
  ~StreamPublisher();
  StreamPublisher(const StreamPublisher&) = delete;
  StreamPublisher& operator=(const StreamPublisher&) = delete;

  /// Queues `message`. @throws std::invalid_argument when a field is out of its bounds or the
  /// session is another one, and the exception of an earlier message that could not be sent
  template <BulkMessage Message>
  void publish(Message message);

  /// The same for a patch. With `supersede`, the points of earlier revisions that still wait to be
  /// sent are left out.
  void publish_patch(CloudSlice patch, bool supersede);

  /// Queues a full state: messages after which a receiver needs none that were sent before them.
  /// `messages` is not empty. @throws as publish()
  template <BulkMessage Message>
  void publish_state(std::vector<Message> messages);

  /// Queues the chunks of a request. Returns false if it is for another session or channel.
  bool request(const ResendRequest& request);
  /// From now on bus.handle() passes the requests on the bus to request(). This must outlive the
  /// last bus.handle().
  void subscribe(Bus& bus);

  /// Waits until everything that is queued and a heartbeat after it are sent.
  /// @throws the exception with which sending has failed
  void flush();

  std::int64_t chunks_published() const;  ///< also the next sequence number
  std::size_t queued_bytes() const;       ///< of messages not yet sent in full
  StreamPublisherCounts counts() const;
  /// Seconds since the last request, or since the start if there was none; time in which the
  /// process was stopped does not count.
  double time_since_request_s() const;

 private:
  template <BulkMessage Message>
  StreamSender::Job job_of(std::shared_ptr<const Message> message) const;
  void enqueue(std::vector<StreamSender::Job> jobs);
  void run();
  // With the lock held:
  std::vector<ResendRequest> hand_over(double now_s);
  void note_progress(double now_s);

  const std::string channel_;
  const std::int64_t session_;
  const std::size_t max_chunk_bytes_;
  PatientClock clock_;
  StreamSender sender_;  // used by the thread alone

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable wake_;
  std::condition_variable done_;
  std::vector<StreamSender::Job> new_jobs_;  // to be taken by the thread, as new_requests_
  std::vector<ResendRequest> new_requests_;
  std::size_t new_bytes_ = 0;  // of new_jobs_
  bool has_news_ = false;      // wakes the thread
  int num_flushing_ = 0;       // callers of flush() that wait
  bool stopping_ = false;
  std::exception_ptr failure_;
  bool sender_is_done_ = false;  // from here on: the state of sender_ at its last step
  std::int64_t next_sequence_ = 0;
  std::size_t queued_bytes_ = 0;
  StreamPublisherCounts counts_;
  std::int64_t requests_bad_ = 0;
  double last_request_s_ = 0.0;
  double now_s_ = 0.0;

  std::thread thread_;
};

}  // namespace kintsugi

#include "lcmtypes/stream/stream_publisher.hpp"

#include <chrono>
#include <memory>
#include <stdexcept>
#include <utility>

#include "lcmtypes/channels.hpp"

namespace kintsugi {
namespace {

// Requests that wait for the thread. Only many receivers, or a hostile one, send more while the
// thread is held up. Further requests are dropped; receivers repeat them.
constexpr std::size_t kMaxWaitingRequests = 256;

}  // namespace

StreamPublisher::StreamPublisher(Bus& bus, std::string channel, std::int64_t session,
                                 const Config& config, SentStore* store)
    : StreamPublisher([&bus](const std::string& to, ByteView message) { bus.publish(to, message); },
                      std::move(channel), session, config, store) {}

StreamPublisher::StreamPublisher(Transmit transmit, std::string channel, std::int64_t session,
                                 const Config& config, SentStore* store)
    : channel_(std::move(channel)),
      session_(session),
      max_chunk_bytes_(config.max_chunk_bytes),
      sender_(std::move(transmit), channel_, session, config, store),
      next_sequence_(sender_.next_sequence()),
      thread_([this] { run(); }) {}

StreamPublisher::~StreamPublisher() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    has_news_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

template <BulkMessage Message>
StreamSender::Job StreamPublisher::job_of(std::shared_ptr<const Message> message) const {
  if (message->session != session_) {
    throw std::invalid_argument("StreamPublisher: the message's session is " +
                                std::to_string(message->session) + ", expected " +
                                std::to_string(session_));
  }
  StreamSender::Job job;
  job.num_chunks = num_chunks(*message, max_chunk_bytes_);
  job.bytes = static_cast<std::size_t>(payload_bytes(*message));
  job.encode = [limit = max_chunk_bytes_, message = std::move(message)](std::int64_t sequence,
                                                                        std::int32_t index) {
    return encode_chunk(*message, sequence, index, limit);
  };
  return job;
}

template <BulkMessage Message>
void StreamPublisher::publish(Message message) {
  std::vector<StreamSender::Job> jobs;
  jobs.push_back(job_of(std::make_shared<const Message>(std::move(message))));
  enqueue(std::move(jobs));
}

void StreamPublisher::publish_patch(CloudSlice patch, bool supersede) {
  std::vector<CloudPoint> points_W = std::exchange(patch.points_W, {});
  CloudSlice header = patch;
  header.superseded = true;
  patch.points_W = std::move(points_W);
  std::vector<StreamSender::Job> jobs;
  StreamSender::Job& job =
      jobs.emplace_back(job_of(std::make_shared<const CloudSlice>(std::move(patch))));
  if (supersede) job.key = header.id;
  job.encode_superseded = [limit = max_chunk_bytes_, header](std::int64_t sequence) {
    return encode_chunk(header, sequence, 0, limit);
  };
  enqueue(std::move(jobs));
}

template <BulkMessage Message>
void StreamPublisher::publish_state(std::vector<Message> messages) {
  std::vector<StreamSender::Job> jobs;
  jobs.reserve(messages.size());
  for (Message& message : messages) {
    jobs.push_back(job_of(std::make_shared<const Message>(std::move(message))));
  }
  if (jobs.empty())
    throw std::invalid_argument("StreamPublisher: a full state needs at least one message");
  jobs.front().starts_state = true;
  enqueue(std::move(jobs));
}

template void StreamPublisher::publish(CloudSlice);
template void StreamPublisher::publish(SegmentUpdate);
template void StreamPublisher::publish(SegmentAnswer);
template void StreamPublisher::publish(RgbdFrameMessage);
template void StreamPublisher::publish(CameraView);
template void StreamPublisher::publish(KeyframeMessage);
template void StreamPublisher::publish(Snapshot);
template void StreamPublisher::publish_state(std::vector<CloudSlice>);
template void StreamPublisher::publish_state(std::vector<SegmentUpdate>);

void StreamPublisher::enqueue(std::vector<StreamSender::Job> jobs) {
  {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
    for (StreamSender::Job& job : jobs) {
      new_bytes_ += job.bytes;
      new_jobs_.push_back(std::move(job));
    }
    has_news_ = true;
  }
  wake_.notify_all();
}

bool StreamPublisher::request(const ResendRequest& request) {
  if (request.session != session_ || request.channel != channel_) return false;
  {
    const std::lock_guard lock(mutex_);
    if (new_requests_.size() < kMaxWaitingRequests) new_requests_.push_back(request);
    has_news_ = true;
  }
  wake_.notify_all();
  return true;
}

void StreamPublisher::subscribe(Bus& bus) {
  bus.subscribe(channels::kResendRequest, [this](ByteView message) {
    try {
      request(decode<ResendRequest>(message));
    } catch (const DecodeError&) {
      const std::lock_guard lock(mutex_);
      ++requests_bad_;
    }
  });
}

void StreamPublisher::flush() {
  std::unique_lock lock(mutex_);
  ++num_flushing_;
  has_news_ = true;
  wake_.notify_all();
  done_.wait(lock, [this] { return failure_ || (new_jobs_.empty() && sender_is_done_); });
  --num_flushing_;
  if (failure_) std::rethrow_exception(failure_);
}

std::int64_t StreamPublisher::chunks_published() const {
  const std::lock_guard lock(mutex_);
  return next_sequence_;
}

std::size_t StreamPublisher::queued_bytes() const {
  const std::lock_guard lock(mutex_);
  return new_bytes_ + queued_bytes_;
}

StreamPublisherCounts StreamPublisher::counts() const {
  const std::lock_guard lock(mutex_);
  StreamPublisherCounts counts = counts_;
  counts.requests_bad = requests_bad_;
  return counts;
}

double StreamPublisher::time_since_request_s() const {
  const std::lock_guard lock(mutex_);
  return now_s_ - last_request_s_;
}

void StreamPublisher::run() {
  try {
    std::unique_lock lock(mutex_);
    while (true) {
      const double now_s = clock_.now_s();
      const std::vector<ResendRequest> requests = hand_over(now_s);
      if (stopping_ && sender_.is_done()) return;
      lock.unlock();
      for (const ResendRequest& request : requests) sender_.request(request, now_s);
      const double wait_s = sender_.step(now_s);
      lock.lock();
      note_progress(now_s);
      if (wait_s > 0.0) {
        wake_.wait_for(lock, std::chrono::duration<double>(wait_s), [this] { return has_news_; });
      }
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    done_.notify_all();
  }
}

/// Passes new jobs to the sender, and returns the new requests. The caller passes these to the
/// sender without the lock, because they call on_state_wanted.
std::vector<ResendRequest> StreamPublisher::hand_over(double now_s) {
  has_news_ = false;
  if (!new_requests_.empty()) last_request_s_ = now_s;
  for (StreamSender::Job& job : new_jobs_) sender_.push(std::move(job));
  new_jobs_.clear();
  new_bytes_ = 0;
  if (stopping_ || num_flushing_ > 0) sender_.announce();
  note_progress(now_s);
  return std::exchange(new_requests_, {});
}

void StreamPublisher::note_progress(double now_s) {
  now_s_ = now_s;
  next_sequence_ = sender_.next_sequence();
  queued_bytes_ = sender_.queued_bytes();
  counts_ = sender_.counts();
  sender_is_done_ = sender_.is_done();
  if (sender_is_done_ && num_flushing_ > 0) done_.notify_all();
}

}  // namespace kintsugi

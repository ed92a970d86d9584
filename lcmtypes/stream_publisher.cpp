#include "lcmtypes/stream_publisher.hpp"

#include <stdexcept>

#include "lcmtypes/channels.hpp"

namespace kintsugi {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("StreamPublisher: " + what);
}

const StreamPublisher::Config& validated(const StreamPublisher::Config& config) {
  config.validate();
  return config;
}

}  // namespace

void StreamPublisher::Config::validate() const {
  if (!(rate_bytes_per_s > 0.0)) {
    refuse("rate_bytes_per_s is " + std::to_string(rate_bytes_per_s) + ", expected > 0");
  }
  if (burst_bytes == 0) refuse("burst_bytes is 0, expected > 0");
  if (max_chunk_bytes < kMinMaxChunkBytes) {
    refuse("max_chunk_bytes is " + std::to_string(max_chunk_bytes) + ", expected at least " +
           std::to_string(kMinMaxChunkBytes));
  }
  if (heartbeat_period.count() <= 0) {
    refuse("heartbeat_period is " + std::to_string(heartbeat_period.count()) + " ms, expected > 0");
  }
}

StreamPublisher::StreamPublisher(Bus& bus, std::string channel, std::int64_t session,
                                 const Config& config, SentStore* store)
    : StreamPublisher([&bus](const std::string& to, ByteView message) { bus.publish(to, message); },
                      std::move(channel), session, config, store) {}

StreamPublisher::StreamPublisher(Transmit transmit, std::string channel, std::int64_t session,
                                 const Config& config, SentStore* store)
    : transmit_(std::move(transmit)),
      channel_(std::move(channel)),
      session_(session),
      config_(validated(config)),
      store_(store),
      bucket_(config.rate_bytes_per_s, static_cast<double>(config.burst_bytes)),
      thread_([this] { run(); }) {}

StreamPublisher::~StreamPublisher() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

template <BulkMessage Message>
void StreamPublisher::publish(Message message) {
  if (message.session != session_) {
    refuse("the message's session is " + std::to_string(message.session) + ", expected " +
           std::to_string(session_));
  }
  Job job;
  job.num_chunks = num_chunks(message, config_.max_chunk_bytes);
  job.bytes = static_cast<std::size_t>(payload_bytes(message));
  job.encode = [limit = config_.max_chunk_bytes,
                shared = std::make_shared<const Message>(std::move(message))](std::int64_t sequence,
                                                                              std::int32_t index) {
    return encode_chunk(*shared, sequence, index, limit);
  };
  enqueue(std::move(job));
}

template void StreamPublisher::publish(CloudSlice);
template void StreamPublisher::publish(SegmentUpdate);
template void StreamPublisher::publish(RgbdFrameMessage);
template void StreamPublisher::publish(Snapshot);

void StreamPublisher::enqueue(Job job) {
  {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
    queued_bytes_ += job.bytes;
    queue_.push_back(std::move(job));
  }
  wake_.notify_all();
}

void StreamPublisher::flush() {
  std::unique_lock lock(mutex_);
  ++num_flushing_;
  wake_.notify_all();
  idle_.wait(lock, [this] {
    return failure_ || (queue_.empty() && heartbeat_sequence_ == next_sequence_);
  });
  --num_flushing_;
  if (failure_) std::rethrow_exception(failure_);
}

std::int64_t StreamPublisher::chunks_published() const {
  const std::lock_guard lock(mutex_);
  return next_sequence_;
}

std::size_t StreamPublisher::queued_bytes() const {
  const std::lock_guard lock(mutex_);
  return queued_bytes_;
}

void StreamPublisher::run() {
  try {
    std::unique_lock lock(mutex_);
    while (true) {
      if (!queue_.empty()) {
        send_message(lock);
      } else if (heartbeat_is_due()) {
        send_heartbeat(lock);
      } else if (stopping_) {
        return;
      } else {
        wake_.wait_until(lock, next_heartbeat_);
      }
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    idle_.notify_all();
  }
}

/// Every heartbeat_period; and at once when somebody waits until everything is sent.
bool StreamPublisher::heartbeat_is_due() const {
  const bool is_waited_for = stopping_ || num_flushing_ > 0;
  return Clock::now() >= next_heartbeat_ ||
         (is_waited_for && heartbeat_sequence_ != next_sequence_);
}

void StreamPublisher::send_message(std::unique_lock<std::mutex>& lock) {
  const Job& job = queue_.front();  // stays where it is while others are added behind it
  for (std::int32_t index = 0; index < job.num_chunks; ++index) {
    const std::int64_t sequence = next_sequence_;
    lock.unlock();
    const Bytes chunk = job.encode(sequence, index);
    if (store_ != nullptr) store_->add(sequence, chunk);
    pace(chunk.size());
    transmit_(channel_, chunk);
    lock.lock();
    ++next_sequence_;
    if (Clock::now() >= next_heartbeat_) send_heartbeat(lock);
  }
  queued_bytes_ -= job.bytes;
  queue_.pop_front();
}

void StreamPublisher::send_heartbeat(std::unique_lock<std::mutex>& lock) {
  Heartbeat heartbeat;
  heartbeat.session = session_;
  heartbeat.channel = channel_;
  heartbeat.next_sequence = next_sequence_;
  lock.unlock();
  heartbeat.utime = wall_clock_us();
  heartbeat.first_sequence = store_ != nullptr ? store_->first_sequence() : heartbeat.next_sequence;
  transmit_(channels::kHeartbeat, encode(heartbeat));
  next_heartbeat_ = Clock::now() + config_.heartbeat_period;
  lock.lock();
  heartbeat_sequence_ = heartbeat.next_sequence;
  idle_.notify_all();
}

void StreamPublisher::pace(std::size_t bytes) {
  const auto size = static_cast<double>(bytes);
  const auto now_s = [this] {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  };
  const double delay_s = bucket_.delay_s(size, now_s());
  if (delay_s > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(delay_s));
  bucket_.take(size, now_s());
}

}  // namespace kintsugi

#include "lcmtypes/stream/stream_sender.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"

namespace kintsugi {
namespace {

// The shortest wait for the token bucket: after it the thread sends several small chunks, so that
// it does not wake for each. Limited below to the time in which the bucket fills by half.
constexpr double kMinWait_s = 0.001;

// A small message costs as much as one of this size. A subscriber of LCM holds 30 messages unless
// it asks for more, which lcm-logger does not, and then drops what comes: with this a burst of the
// default size has at most 15. The kernel, too, charges a receive buffer 800 to 2,500 bytes more
// for a datagram than it has.
constexpr std::size_t kLeastCost_bytes = 8'000;

double cost_of(const Bytes& chunk) {
  return static_cast<double>(std::max(chunk.size(), kLeastCost_bytes));
}

const StreamPublisherConfig& validated(const StreamPublisherConfig& config) {
  config.validate();
  return config;
}

}  // namespace

void StreamPublisherConfig::validate() const {
  require(rate_bytes_per_s > 0.0, "StreamPublisher: rate_bytes_per_s", rate_bytes_per_s, "> 0");
  require(burst_bytes > 0, "StreamPublisher: burst_bytes", burst_bytes, "> 0");
  require(max_chunk_bytes >= kMinMaxChunkBytes, "StreamPublisher: max_chunk_bytes", max_chunk_bytes,
          "at least " + std::to_string(kMinMaxChunkBytes));
  require(heartbeat_period.count() > 0, "StreamPublisher: heartbeat_period in ms",
          heartbeat_period.count(), "> 0");
}

StreamSender::StreamSender(Transmit transmit, std::string channel, std::int64_t session,
                           const Config& config, SentStore* store)
    : transmit_(std::move(transmit)),
      channel_(std::move(channel)),
      session_(session),
      config_(validated(config)),
      store_(store),
      resumed_end_(store != nullptr ? store->next_sequence() : 0),
      bucket_(config.rate_bytes_per_s, static_cast<double>(config.burst_bytes)),
      min_wait_s_(std::min(
          kMinWait_s, 0.5 * static_cast<double>(config.burst_bytes) / config.rate_bytes_per_s)) {}

void StreamSender::push(Job job) {
  if (job.key) supersede(*job.key);
  queued_bytes_ += job.bytes;
  jobs_.push_back(std::move(job));
}

/// Leaves out the payload of a message that waits and has not begun. Its place in the stream stays:
/// so a sender that makes the same messages again finds each of them there.
void StreamSender::supersede(std::int64_t key) {
  if (sequence_ < resumed_end_) return;  // those that wait may have been sent already
  const std::size_t first = next_index_ > 0 || prepared_ ? 1 : 0;
  for (std::size_t i = first; i < jobs_.size(); ++i) {
    Job& job = jobs_[i];
    if (job.key != key) continue;
    job.key.reset();
    job.encode = [encode = job.encode_superseded](std::int64_t sequence, std::int32_t /*index*/) {
      return encode(sequence);
    };
    job.num_chunks = 1;
    queued_bytes_ -= std::exchange(job.bytes, 0);
    ++counts_.messages_superseded;
  }
}

void StreamSender::request(const ResendRequest& request, double now_s) {
  ++counts_.requests_received;
  const std::int64_t first = first_sequence();
  const auto is_lost = [&](const SequenceRange& range) {  // one in [state_sequence_, first)
    return std::max(range.first, state_sequence_) < std::min(range.last + 1, first);
  };
  if (config_.on_state_wanted &&
      std::any_of(request.ranges.begin(), request.ranges.end(), is_lost)) {
    config_.on_state_wanted();
  }
  resends_.want(request.ranges, std::max(first, state_sequence_), next_sequence(), now_s);
}

double StreamSender::step(double now_s) {
  const bool has_news = announce_ && jobs_.empty() && announced_ != next_sequence();
  if (has_news || now_s >= next_heartbeat_s_) {
    send_heartbeat(now_s);
  } else if (!jobs_.empty() && sequence_ < resumed_end_) {
    compare_with_store();
  } else {
    if (!prepared_) prepare();
    if (!prepared_) {
      const bool is_idle = jobs_.empty() && resends_.empty();
      return is_idle ? next_heartbeat_s_ - now_s : 0.0;
    }
    const double wait_s = bucket_.delay_s(cost_of(prepared_->chunk), now_s);
    if (wait_s > 0.0) return std::min(std::max(wait_s, min_wait_s_), next_heartbeat_s_ - now_s);
    send_prepared(now_s);
  }
  return 0.0;
}

std::int64_t StreamSender::next_sequence() const { return std::max(sequence_, resumed_end_); }

/// The lowest number that can be resent. The store may have one chunk more than was sent, the
/// prepared one.
std::int64_t StreamSender::first_sequence() const {
  return store_ != nullptr ? std::min(store_->first_sequence(), next_sequence()) : next_sequence();
}

Bytes StreamSender::encode_next() const { return jobs_.front().encode(sequence_, next_index_); }

void StreamSender::compare_with_store() {
  const std::optional<Bytes> stored = store_->find(sequence_);
  Job& job = jobs_.front();
  if (stored && job.encode_superseded && *stored == job.encode_superseded(sequence_)) {
    job.num_chunks = 1;
  } else if (stored && *stored != encode_next()) {
    throw std::runtime_error(channel_ + ", sequence " + std::to_string(sequence_) +
                             ": differs from what was sent before: resume with the same device "
                             "and options");
  }
  ++counts_.chunks_compared;
  finish_chunk();
}

/// Sets prepared_ to the next chunk, and stores it if it is new. Sets nothing if there is none, or
/// if the requested one is no longer in the store.
void StreamSender::prepare() {
  if (const auto sequence = resends_.next(!jobs_.empty())) {
    auto chunk = store_->find(*sequence);
    if (chunk) prepared_ = {*sequence, true, *std::move(chunk)};
    return;
  }
  if (jobs_.empty()) return;
  prepared_ = {sequence_, false, encode_next()};
  if (store_ != nullptr) store_->add(sequence_, prepared_->chunk);
}

void StreamSender::send_prepared(double now_s) {
  const Next next = *std::exchange(prepared_, std::nullopt);
  const std::size_t size = next.chunk.size();
  transmit_(channel_, next.chunk);
  bucket_.take(cost_of(next.chunk), now_s);
  resends_.sent(next.sequence, now_s);
  (next.is_resend ? counts_.chunks_resent : counts_.chunks_sent) += 1;
  (next.is_resend ? counts_.bytes_resent : counts_.bytes_sent) += static_cast<std::int64_t>(size);
  if (!next.is_resend) finish_chunk();
}

void StreamSender::finish_chunk() {
  const Job& job = jobs_.front();
  if (job.starts_state && next_index_ == 0) state_sequence_ = sequence_;
  ++sequence_;
  if (++next_index_ < job.num_chunks) return;
  next_index_ = 0;
  queued_bytes_ -= job.bytes;
  jobs_.pop_front();
}

void StreamSender::send_heartbeat(double now_s) {
  Heartbeat heartbeat;
  heartbeat.utime = wall_clock_us();
  heartbeat.session = session_;
  heartbeat.channel = channel_;
  heartbeat.map_name = config_.map_name;
  heartbeat.first_sequence = first_sequence();
  heartbeat.state_sequence = state_sequence_;
  heartbeat.next_sequence = next_sequence();
  transmit_(channels::kHeartbeat, encode(heartbeat));
  announced_ = heartbeat.next_sequence;
  announce_ = false;
  next_heartbeat_s_ = now_s + std::chrono::duration<double>(config_.heartbeat_period).count();
}

}  // namespace kintsugi

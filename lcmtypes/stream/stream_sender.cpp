#include "lcmtypes/stream/stream_sender.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"

namespace kintsugi {
namespace {

// A thread that waits for the token bucket wakes no more often, and then sends several small
// chunks; as long as the bucket can hold what flows meanwhile.
constexpr double kMinWait_s = 0.001;

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("StreamPublisher: " + what);
}

const StreamPublisherConfig& validated(const StreamPublisherConfig& config) {
  config.validate();
  return config;
}

}  // namespace

void StreamPublisherConfig::validate() const {
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
  queued_bytes_ += job.bytes;
  jobs_.push_back(std::move(job));
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
    const double wait_s = bucket_.delay_s(static_cast<double>(prepared_->chunk.size()), now_s);
    if (wait_s > 0.0) return std::min(std::max(wait_s, min_wait_s_), next_heartbeat_s_ - now_s);
    send_prepared(now_s);
  }
  return 0.0;
}

std::int64_t StreamSender::next_sequence() const { return std::max(sequence_, resumed_end_); }

/// The oldest that can be resent. The store may be ahead, by the chunk that is prepared.
std::int64_t StreamSender::first_sequence() const {
  return store_ != nullptr ? std::min(store_->first_sequence(), next_sequence()) : next_sequence();
}

Bytes StreamSender::encode_next() const { return jobs_.front().encode(sequence_, next_index_); }

void StreamSender::compare_with_store() {
  const std::optional<Bytes> stored = store_->find(sequence_);
  if (stored && *stored != encode_next()) {
    throw std::runtime_error(channel_ + ", sequence " + std::to_string(sequence_) +
                             ": differs from what was sent before: resume with the same device "
                             "and options");
  }
  ++counts_.chunks_compared;
  finish_chunk();
}

/// Decides what goes next, and keeps a new chunk before it goes. Nothing, too, when what was asked
/// for is no longer kept.
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
  bucket_.take(static_cast<double>(size), now_s);
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

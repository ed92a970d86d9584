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

// How often the sender asks whether a chunk is safe in the store: little against the time that a
// disk needs.
constexpr double kStoreWait_s = 0.005;

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
  const std::size_t first = next_index_ > 0 ? 1 : 0;
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
  note_replaced(request.ranges);
  resends_.want(request.ranges, std::max(first, state_sequence_), next_sequence(), now_s);
}

void StreamSender::note_replaced(const std::vector<SequenceRange>& asked) {
  if (store_ == nullptr) return;
  for (const SequenceRange& range : asked) {
    const std::vector<SequenceRange> next = store_->replaced(range.first, 1);
    if (next.empty() || next.front().first > range.last) continue;
    const std::int64_t lowest = std::max(range.first, next.front().first);
    replaced_ = std::min(replaced_.value_or(lowest), lowest);
  }
}

double StreamSender::step(double now_s) {
  const bool has_news = announce_ && !has_new_chunks() && announced_ != next_sequence();
  if (has_news || now_s >= next_heartbeat_s_) {
    send_heartbeat(now_s);
  } else if (!jobs_.empty() && sequence_ < resumed_end_) {
    compare_with_store();
  } else if (replaced_ && now_s >= next_replaced_s_) {
    const double wait_s = wait_for_tokens(kLeastCost_bytes, now_s);
    if (wait_s > 0.0) return wait_s;
    send_replaced(now_s);
  } else {
    if (!prepared_) prepare();
    if (!prepared_) {
      double idle_s = next_heartbeat_s_ - now_s;
      if (replaced_) idle_s = std::min(idle_s, next_replaced_s_ - now_s);
      if (!resends_.empty()) return 0.0;
      if (waits_for_store()) return std::min(kStoreWait_s, idle_s);
      return has_new_chunks() ? 0.0 : idle_s;
    }
    const double wait_s = wait_for_tokens(cost_of(prepared_->chunk), now_s);
    if (wait_s > 0.0) return wait_s;
    send_prepared(now_s);
  }
  return 0.0;
}

double StreamSender::wait_for_tokens(double cost, double now_s) {
  const double wait_s = bucket_.delay_s(cost, now_s);
  if (wait_s <= 0.0) return 0.0;
  return std::min(std::max(wait_s, min_wait_s_), next_heartbeat_s_ - now_s);
}

std::int64_t StreamSender::next_sequence() const { return std::max(sent_end_, resumed_end_); }

/// That were pushed and not sent.
bool StreamSender::has_new_chunks() const {
  return !jobs_.empty() || !stored_.empty() || (prepared_ && !prepared_->is_resend);
}

bool StreamSender::waits_for_store() const {
  return !stored_.empty() && store_ != nullptr && !store_->is_safe(stored_.front().sequence);
}

/// The lowest number that can be resent. The store may have more chunks than were sent.
std::int64_t StreamSender::first_sequence() const {
  return store_ != nullptr ? std::min(store_->first_sequence(), next_sequence()) : next_sequence();
}

Bytes StreamSender::encode_next() const { return jobs_.front().encode(sequence_, next_index_); }

void StreamSender::compare_with_store() {
  Job& job = jobs_.front();
  std::optional<Bytes> stored = store_->find(sequence_);
  const ChunkFate fate = store_->fate(sequence_);
  if (fate != ChunkFate::kKept) stored.reset();  // it cannot be compared
  const bool was_superseded =
      fate == ChunkFate::kSuperseded ||
      (stored && job.encode_superseded && *stored == job.encode_superseded(sequence_));
  if (was_superseded) {
    job.num_chunks = 1;
  } else if (stored && *stored != encode_next()) {
    throw std::runtime_error(channel_ + ", sequence " + std::to_string(sequence_) +
                             ": differs from what was sent before: resume with the same device "
                             "and options");
  }
  ++counts_.chunks_compared;
  if (job.starts_state && next_index_ == 0) state_sequence_ = sequence_;
  sent_end_ = sequence_ + 1;
  queued_bytes_ -= advance();
}

/// Sets prepared_ to the next chunk, and stores new ones. Sets nothing if there is none, if it is
/// not safe in the store yet, or if the requested one is no longer in the store.
void StreamSender::prepare() {
  const bool has_new = stored_.empty() ? !jobs_.empty() : !waits_for_store();
  if (const auto sequence = resends_.next(has_new)) {
    auto chunk = store_->find(*sequence);
    if (chunk) prepared_ = {.sequence = *sequence, .is_resend = true, .chunk = *std::move(chunk)};
    return;
  }
  store_ahead();
  if (stored_.empty() || waits_for_store()) return;
  stored_bytes_ -= stored_.front().chunk.size();
  prepared_ = std::move(stored_.front());
  stored_.pop_front();
}

/// One chunk, and more only while it is not safe: what is stored cannot be superseded any more.
void StreamSender::store_ahead() {
  const auto is_enough = [this] {
    return static_cast<double>(stored_bytes_) >= config_.rate_bytes_per_s || !waits_for_store();
  };
  while (!jobs_.empty() && (stored_.empty() || !is_enough())) store_next();
}

void StreamSender::store_next() {
  Next next{.sequence = sequence_,
            .is_resend = false,
            .chunk = encode_next(),
            .starts_state = jobs_.front().starts_state && next_index_ == 0};
  if (store_ != nullptr) store_->add(sequence_, next.chunk);
  next.job_bytes = advance();
  stored_bytes_ += next.chunk.size();
  stored_.push_back(std::move(next));
}

void StreamSender::send_prepared(double now_s) {
  const Next next = *std::exchange(prepared_, std::nullopt);
  const std::size_t size = next.chunk.size();
  transmit_(channel_, next.chunk);
  bucket_.take(cost_of(next.chunk), now_s);
  resends_.sent(next.sequence, now_s);
  (next.is_resend ? counts_.chunks_resent : counts_.chunks_sent) += 1;
  (next.is_resend ? counts_.bytes_resent : counts_.bytes_sent) += static_cast<std::int64_t>(size);
  if (next.is_resend) return;
  if (next.starts_state) state_sequence_ = next.sequence;
  sent_end_ = next.sequence + 1;
  queued_bytes_ -= next.job_bytes;
}

/// As many ranges as fit, from the lowest on that was asked for: who misses that one, because it is
/// late, misses most of the others, too. Not more often than chunks are sent again.
void StreamSender::send_replaced(double now_s) {
  ChunksReplaced message;
  message.utime = wall_clock_us();
  message.session = session_;
  message.channel = channel_;
  message.map_name = config_.map_name;
  const std::size_t bytes_left = config_.max_chunk_bytes - encode(message).size();
  message.ranges = store_->replaced(
      *std::exchange(replaced_, std::nullopt),
      std::min<std::size_t>(kMaxResendRanges, bytes_left / (2 * sizeof(std::int64_t))));
  next_replaced_s_ = now_s + ResendQueue::kInFlight_s;
  if (message.ranges.empty()) return;
  const Bytes bytes = encode(message);
  transmit_(channels::kChunksReplaced, bytes);
  bucket_.take(cost_of(bytes), now_s);
}

/// Goes on to the next chunk of the jobs. Returns the bytes of the message that ends here, else 0.
std::size_t StreamSender::advance() {
  ++sequence_;
  if (++next_index_ < jobs_.front().num_chunks) return 0;
  const std::size_t bytes = jobs_.front().bytes;
  next_index_ = 0;
  jobs_.pop_front();
  return bytes;
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

#pragma once
// One sender and several receivers of a stream on a simulated network with a simulated clock:
// minutes of loss, delay, stalls and crashes take milliseconds and are the same in every run.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_sender.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "tests/support/simulation.hpp"

namespace kintsugi::testing {

/// Independent probabilities of what happens to a datagram.
struct Link {
  double loss = 0.0;
  double duplication = 0.0;
  double reordering = 0.0;         ///< delayed by up to max_reordering_s more
  double max_reordering_s = 0.03;  ///< shorter than a receiver waits before it asks
  double delay_s = 0.001;
};

/// A process that receives the stream.
class SimulatedReceiver {
 public:
  using Subscriber = StreamSubscriber<CloudSlice>;
  static constexpr std::size_t kSocketBytes = 200'000;
  static constexpr double kTickPeriod_s = 0.02;

  Link link;
  std::map<std::int32_t, int> times_received;  // by slice
  std::int64_t datagrams_lost = 0;             // of chunks
  std::int64_t datagrams_unsocketed = 0;       // of them, because the socket buffer was full
  std::int64_t requests = 0;
  std::int64_t chunks_asked = 0;  // a chunk that is requested twice counts twice
  double last_request_s = 0.0;
  std::size_t max_pending_bytes = 0;
  std::function<void(const ResendRequest&)> on_request;

  SimulatedReceiver(Simulation& simulation, const Link& its_link, std::uint32_t seed,
                    const Subscriber::Config& config = {})
      : link(its_link),
        subscriber(
            channels::kCloudSlice, [this](const CloudSlice& slice) { ++times_received[slice.id]; },
            {}, config),
        simulation_(simulation),
        random_(seed),
        clock_([this] { return simulation_.now_s(); }) {
    tick();
  }

  Subscriber subscriber;

  /// A datagram on its way to this process.
  void send(const std::string& channel, const std::shared_ptr<const Bytes>& bytes) {
    if (happens(link.loss)) {
      if (channel != channels::kHeartbeat) ++datagrams_lost;
      return;
    }
    for (int copies = happens(link.duplication) ? 2 : 1; copies > 0; --copies) {
      const double more_s = happens(link.reordering) ? link.max_reordering_s * uniform() : 0.0;
      simulation_.after(link.delay_s + more_s, [this, channel, bytes] { arrive(channel, bytes); });
    }
  }

  /// Like SIGSTOP and SIGCONT.
  void stop() { stopped_ = true; }
  void go_on() {
    stopped_ = false;
    socket_bytes_ = 0;
    for (const auto& [channel, bytes] : std::exchange(socket_, {})) handle(channel, *bytes);
  }

 private:
  void arrive(const std::string& channel, const std::shared_ptr<const Bytes>& bytes) {
    if (!stopped_) return handle(channel, *bytes);
    if (socket_bytes_ + bytes->size() > kSocketBytes) {
      if (channel == channels::kHeartbeat) return;
      ++datagrams_lost;
      ++datagrams_unsocketed;
      return;
    }
    socket_bytes_ += bytes->size();
    socket_.emplace_back(channel, bytes);
  }

  void handle(const std::string& channel, const Bytes& bytes) {
    subscriber.handle(channel, bytes);
    max_pending_bytes = std::max(max_pending_bytes, subscriber.pending_bytes());
  }

  void tick() {
    simulation_.after(kTickPeriod_s, [this] { tick(); });
    if (stopped_) return;
    for (const ResendRequest& request : subscriber.poll(clock_.now_s())) {
      ++requests;
      last_request_s = simulation_.now_s();
      for (const SequenceRange& range : request.ranges) {
        chunks_asked += range.last - range.first + 1;
      }
      if (happens(link.loss)) continue;
      simulation_.after(link.delay_s, [this, request] { on_request(request); });
    }
  }

  double uniform() { return std::uniform_real_distribution<double>()(random_); }
  bool happens(double probability) { return uniform() < probability; }

  Simulation& simulation_;
  std::mt19937 random_;
  PatientClock clock_;
  bool stopped_ = false;
  std::size_t socket_bytes_ = 0;
  std::vector<std::pair<std::string, std::shared_ptr<const Bytes>>> socket_;
};

/// The process that sends, and its network.
class SimulatedSender {
 public:
  std::vector<std::unique_ptr<SimulatedReceiver>> receivers;
  std::int64_t chunks_on_wire = 0;

  SimulatedSender(Simulation& simulation, const StreamPublisherConfig& config, SentStore* store,
                  std::int64_t session = 42)
      : simulation_(simulation), config_(config), store_(store), session_(session) {
    start();
  }

  SimulatedReceiver& join(const Link& link, std::uint32_t seed,
                          const SimulatedReceiver::Subscriber::Config& config = {}) {
    auto& receiver = *receivers.emplace_back(
        std::make_unique<SimulatedReceiver>(simulation_, link, seed, config));
    receiver.on_request = [this](const ResendRequest& request) {
      if (!sender_ || request.session != session_) return;
      sender_->request(request, simulation_.now_s());
      wake();
    };
    return receiver;
  }

  void publish(const CloudSlice& slice, bool starts_state = false) {
    StreamSender::Job job;
    job.num_chunks = num_chunks(slice, config_.max_chunk_bytes);
    job.bytes = static_cast<std::size_t>(payload_bytes(slice));
    job.starts_state = starts_state;
    job.encode = [slice, limit = config_.max_chunk_bytes](std::int64_t sequence,
                                                          std::int32_t index) {
      return encode_chunk(slice, sequence, index, limit);
    };
    sender_->push(std::move(job));
    wake();
  }

  /// Like SIGKILL, followed by a new process that resumes from the store.
  void crash() { sender_.reset(); }
  void start() {
    sender_.emplace(
        [this](const std::string& channel, ByteView message) { transmit(channel, message); },
        channels::kCloudSlice, session_, config_, store_);
    wake();
  }
  bool is_running() const { return sender_.has_value(); }
  StreamSender& sender() { return *sender_; }

 private:
  void transmit(const std::string& channel, ByteView message) {
    if (channel != channels::kHeartbeat) ++chunks_on_wire;
    const auto bytes = std::make_shared<const Bytes>(message.begin(), message.end());
    for (const auto& receiver : receivers) receiver->send(channel, bytes);
  }

  void wake() {
    const std::int64_t wake = ++last_wake_;  // an earlier wake-up then does nothing
    simulation_.after(0.0, [this, wake] { step(wake); });
  }
  void step(std::int64_t wake) {
    if (wake != last_wake_ || !sender_) return;
    const double wait_s = sender_->step(simulation_.now_s());
    simulation_.after(wait_s, [this, wake] { step(wake); });
  }

  Simulation& simulation_;
  const StreamPublisherConfig config_;
  SentStore* const store_;
  const std::int64_t session_;
  std::optional<StreamSender> sender_;
  std::int64_t last_wake_ = 0;
};

}  // namespace kintsugi::testing

#pragma once
// The stream of segment updates.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/stream/sent_store.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"

namespace kintsugi::segmenter {

/// Publishes updates, resends lost ones, and reports when a late joiner requests the full state.
/// Errors of publishing are reported by problem() instead of thrown, because the map is worth
/// keeping even when nobody can listen.
///
/// Resends come from memory and reach back at least to the last full state. The cost of a late
/// joiner is therefore bounded by the size of the map, not by its history.
class UpdatePublisher {
 public:
  struct Config {
    double rate_bytes_per_s = StreamPublisher::Config{}.rate_bytes_per_s;  ///< > 0
    std::string map_name;  ///< when there is only one map; empty: several
    /// Of updates that wait to be sent; when there are more, publish() blocks, to bound memory.
    std::size_t max_queued_bytes = std::size_t{256} << 20U;
    /// Lower bound of the updates kept for resends; twice a full state if that is more.
    std::size_t min_store_bytes = std::size_t{16} << 20U;
    double min_state_period_s = 2.0;  ///< between two full states, >= 0

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };
  struct Counts {
    StreamPublisherCounts stream;
    std::int64_t states = 0;       ///< full states that were published
    std::int64_t state_bytes = 0;  ///< size of the last one
  };

  /// @param bus must outlive this; null: publishes nothing
  /// @throws std::invalid_argument for an invalid config
  UpdatePublisher(Bus* bus, std::int64_t session, const Config& config);

  /// From now on bus.handle() receives resend requests; this must outlive that.
  void subscribe(Bus& bus);

  void publish(SegmentUpdate update);

  /// True when a listener has requested the full state and it is time to call publish_state(): full
  /// states use at most half of the rate. A request that comes too early is dropped; the listener
  /// repeats it unless the state that was being sent was enough. `now_s` never decreases.
  bool take_state_request(double now_s);

  /// Publishes the full state: the updates of SegmentMap::describe() of each map.
  void publish_state(std::vector<SegmentUpdate> updates, double now_s);

  /// Waits until everything is sent.
  void flush();

  // From any thread:
  bool is_idle() const { return queued_bytes() == 0; }
  Counts counts() const;
  /// Since the last request of a listener, or since the start.
  double time_since_request_s() const;
  /// Why an update could not be published, the first time that happened; empty: never.
  std::string problem() const;

 private:
  std::size_t queued_bytes() const { return stream_ ? stream_->queued_bytes() : 0; }
  void wait_for_room() const;
  template <class Action>
  void try_to(const Action& action);

  Config config_;
  RecentChunks store_;
  std::atomic<bool> is_state_wanted_{false};
  double next_state_s_ =
      0.0;  // earliest time of the next full state; used by the publishing thread
  std::atomic<std::int64_t> num_states_{0};
  std::atomic<std::int64_t> state_bytes_{0};
  mutable std::mutex mutex_;  // guards the next
  std::string problem_;
  std::unique_ptr<StreamPublisher> stream_;  // last: it uses the others
};

}  // namespace kintsugi::segmenter

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

/// Publishes what changes, sends again what is asked for, and says when a full state is wanted by
/// somebody who came late. What cannot be published is told of instead of thrown: the map is worth
/// keeping without a listener.
///
/// Resends come from memory, and reach back to the last full state at least. So what a late
/// listener costs is bounded by the map, not by its history.
class UpdatePublisher {
 public:
  struct Config {
    double rate_bytes_per_s = StreamPublisher::Config{}.rate_bytes_per_s;  ///< > 0
    std::string map_name;  ///< of the only map; empty: several
    /// Updates that wait to be sent; beyond it publish() waits too, so that memory is bounded.
    std::size_t max_queued_bytes = std::size_t{256} << 20U;
    /// Updates that can be sent again, at least; twice a full state if that is more.
    std::size_t min_store_bytes = std::size_t{16} << 20U;
    double min_state_period_s = 2.0;  ///< between two full states, >= 0

    /// Throws std::invalid_argument naming field, value and bound.
    void validate() const;
  };
  struct Counts {
    StreamPublisherCounts stream;
    std::int64_t states = 0;       ///< full ones that were published
    std::int64_t state_bytes = 0;  ///< of the last
  };

  /// @param bus must outlive this; null: publishes nothing
  /// @throws std::invalid_argument for an invalid config
  UpdatePublisher(Bus* bus, std::int64_t session, const Config& config);

  /// From now on bus.handle() takes requests for what was lost; this must outlive that.
  void subscribe(Bus& bus);

  void publish(SegmentUpdate update);

  /// True when somebody has asked for what only a full state can tell, and it is time for one:
  /// states take half of the stream at most. Then publish_state(). Who asks at another time asks
  /// again, if the state that was on its way has not helped. `now_s` never decreases.
  bool take_state_request(double now_s);

  /// Publishes updates that together say everything: SegmentMap::describe() of each map.
  void publish_state(std::vector<SegmentUpdate> updates, double now_s);

  /// Waits until everything is sent.
  void flush();

  // From any thread:
  bool is_idle() const { return queued_bytes() == 0; }
  Counts counts() const;
  /// Since somebody last asked for something, or since the start.
  double time_since_request_s() const;
  /// The first thing that could not be published; empty: none.
  std::string problem() const;

 private:
  std::size_t queued_bytes() const { return stream_ ? stream_->queued_bytes() : 0; }
  void wait_for_room() const;
  template <class Action>
  void try_to(const Action& action);

  Config config_;
  RecentChunks store_;
  std::atomic<bool> is_state_wanted_{false};
  double next_state_s_ = 0.0;  // not before; of the thread that publishes
  std::atomic<std::int64_t> num_states_{0};
  std::atomic<std::int64_t> state_bytes_{0};
  mutable std::mutex mutex_;  // guards the next
  std::string problem_;
  std::unique_ptr<StreamPublisher> stream_;  // last: it uses the rest
};

}  // namespace kintsugi::segmenter

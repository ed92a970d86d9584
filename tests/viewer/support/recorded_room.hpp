#pragma once
// A synthetic map as messages on the bus or in a log.

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/stream/sent_store.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "tests/viewer/support/synthetic_room.hpp"

namespace kintsugi::viewer {

struct Recorded {
  bool updates = true;              ///< as with a segmenter running
  std::int64_t session_offset = 0;  ///< added to the map's and the segmenter's sessions
};

/// Writes the messages of `map` in the order of their device time to an LCM log, as lcm-logger
/// would have; `append` goes on where the log ends.
/// @throws std::runtime_error
void write_log(const std::filesystem::path& path, const SyntheticMap& map,
               const Recorded& recorded = {}, bool append = false);

/// A mapper and a segmenter on a bus that resend lost messages on request, while bus.handle() runs
/// and serve() is called repeatedly.
class RoomOnBus {
 public:
  /// `map` must outlive this object, and this object the last bus.handle().
  RoomOnBus(Bus& bus, const SyntheticMap& map);

  /// Publishes the next `count` slices, each with the poses before it and its update. An update
  /// also changes the labels of the first half of the slice before.
  void publish(std::size_t count);

  /// Starts a new segmenter session, which continues with the present labels.
  void restart_segmenter();

  /// Sends the full state if it was requested.
  void serve();

  std::int64_t states_sent() const { return states_sent_; }

 private:
  void begin_segmenter(std::int64_t session);
  std::vector<SegmentUpdate> describe() const;

  Bus& bus_;
  const SyntheticMap& map_;
  std::vector<std::vector<std::uint32_t>> labels_;  // of each slice, now
  std::size_t num_published_ = 0;
  std::size_t num_poses_ = 0;
  std::int64_t segmenter_session_ = 0;
  std::int64_t states_sent_ = 0;
  std::atomic<bool> is_state_wanted_ = false;
  RecentChunks sent_slices_{std::size_t{1} << 30U};
  std::unique_ptr<RecentChunks> sent_updates_;  // before the publishers that use them
  StreamPublisher slices_;
  std::unique_ptr<StreamPublisher> updates_;
};

/// Publishes the whole map at once, for processes that were there from the start.
void publish(Bus& bus, const SyntheticMap& map);

}  // namespace kintsugi::viewer

#pragma once
// What a mapper does on the bus: slices, and again what is asked for.

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/sent_store.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"

namespace kintsugi::segmenter::testing {

/// Publishes slices as chunks of 2 kB, keeps them, and answers requests while bus.handle() runs.
/// A chunk for which `is_lost_at_first` (its number, counted from 0) gives true is lost the first
/// time.
class MapperImitation {
 public:
  using IsLost = std::function<bool(std::int64_t sequence)>;

  MapperImitation(Bus& bus, std::int64_t session, IsLost is_lost_at_first = {})
      : is_lost_(std::move(is_lost_at_first)),
        publisher_(
            [this, &bus](const std::string& channel, ByteView message) {
              if (channel != channels::kCloudSlice || !is_lost(message)) {
                bus.publish(channel, message);
              }
            },
            channels::kCloudSlice, session, config(), &store_) {}

  void publish(const std::vector<CloudSlice>& slices) {
    for (const CloudSlice& slice : slices) publisher_.publish(slice);
  }
  void publish(const CloudSlice& slice) { publisher_.publish(slice); }
  /// From now on; before bus.handle().
  void answer(Bus& bus) { publisher_.subscribe(bus); }
  StreamPublisher& publisher() { return publisher_; }

 private:
  static StreamPublisher::Config config() {
    StreamPublisher::Config config;
    config.max_chunk_bytes = 2000;
    return config;
  }

  bool is_lost(ByteView message) {
    const std::int64_t sequence = decode_chunk<CloudSlice>(message).sequence;
    if (sequence < next_) return false;  // sent again
    next_ = sequence + 1;
    return is_lost_ && is_lost_(sequence);
  }

  IsLost is_lost_;
  std::int64_t next_ = 0;  // of the publisher's thread
  RecentChunks store_{std::numeric_limits<std::size_t>::max()};
  StreamPublisher publisher_;
};

}  // namespace kintsugi::segmenter::testing

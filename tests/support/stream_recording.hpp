#pragma once
// Records what a publisher would send.

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "tests/support/example_messages.hpp"

namespace kintsugi::testing {

/// Largest chunk of these tests.
inline constexpr std::size_t kChunkBytes = 4'000;

/// Everything a publisher transmits, in order.
struct Recording {
  std::vector<Bytes> chunks;
  std::vector<Heartbeat> heartbeats;

  StreamPublisher::Transmit transmit() {
    return [this](const std::string& channel, ByteView message) {
      if (channel == channels::kHeartbeat) {
        heartbeats.push_back(decode<Heartbeat>(message));
      } else {
        chunks.emplace_back(message.begin(), message.end());
      }
    };
  }
};

/// Fast enough that no test waits, and no heartbeats but the first and those of flush(): what is
/// recorded can be read after it.
inline StreamPublisher::Config fast() {
  StreamPublisher::Config config;
  config.rate_bytes_per_s = 1e12;
  config.heartbeat_period = std::chrono::hours(1);
  config.max_chunk_bytes = kChunkBytes;
  return config;
}

/// The message that is published for a slice.
inline std::vector<Bytes> chunks_of(const std::vector<CloudSlice>& slices) {
  Recording recording;
  StreamPublisher publisher(recording.transmit(), channels::kCloudSlice, 42, fast());
  for (const CloudSlice& slice : slices) publisher.publish(slice);
  publisher.flush();
  return recording.chunks;
}

/// Slices 0 .. count - 1.
inline std::vector<CloudSlice> example_slices(int count, int num_points) {
  std::vector<CloudSlice> slices(static_cast<std::size_t>(count));
  for (int id = 0; id < count; ++id) {
    slices[static_cast<std::size_t>(id)] = example_slice(num_points, id);
  }
  return slices;
}

}  // namespace kintsugi::testing

#pragma once
// What the tests of streams on a simulated network share.

#include <algorithm>
#include <cstddef>

#include "tests/support/example_messages.hpp"
#include "tests/support/simulated_network.hpp"

namespace kintsugi::testing {

/// Largest chunks on one host and between hosts, bytes.
inline constexpr std::size_t kDatagram = 60'000;
inline constexpr std::size_t kFrame = 1'400;
inline constexpr std::size_t kAll = 1'000'000'000;  // size of a store that keeps everything, bytes

inline StreamPublisherConfig chunks_of(std::size_t max_chunk_bytes) {
  StreamPublisherConfig config;
  config.max_chunk_bytes = max_chunk_bytes;
  return config;
}

/// `count` slices of `num_points` each, published evenly over `duration_s` from now on.
inline void publish_over(Simulation& simulation, SimulatedSender& sender, int count, int num_points,
                         double duration_s, int first_id = 0) {
  for (int i = 0; i < count; ++i) {
    simulation.after(duration_s * i / count, [&sender, num_points, id = first_id + i] {
      sender.publish(example_slice(num_points, id));
    });
  }
}

inline bool has_each_once(const SimulatedReceiver& receiver, int count) {
  return static_cast<int>(receiver.times_received.size()) == count &&
         std::all_of(receiver.times_received.begin(), receiver.times_received.end(),
                     [](const auto& slice) { return slice.second == 1; });
}

/// Runs until every receiver has `count` slices and knows that none is missing.
inline bool completes(Simulation& simulation, const SimulatedSender& sender, int count,
                      double limit_s) {
  simulation.run_until(simulation.now_s() + limit_s, [&] {
    return std::all_of(sender.receivers.begin(), sender.receivers.end(), [&](const auto& receiver) {
      return has_each_once(*receiver, count) && receiver->subscriber.counts().chunks_missing == 0;
    });
  });
  return std::all_of(sender.receivers.begin(), sender.receivers.end(),
                     [&](const auto& receiver) { return has_each_once(*receiver, count); });
}

}  // namespace kintsugi::testing

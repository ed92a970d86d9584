#pragma once
// Only one mapper at a time may have a map name on a bus.

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/bus/bus_thread.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::mapper {

/// Claims a map name while a mapper starts.
///
/// Segmenters, viewers and scripts/trio follow the newest session of a map name: a second mapper
/// with the same name would take them away from the first. A mapper that runs is known by the
/// heartbeats of its slices, five a second. One that starts has none yet; it sends heartbeats of
/// its claim instead, and of two that start together the one with the lower number goes on.
class MapNameClaim {
 public:
  /// Listens for half a second, time for two heartbeats.
  /// @throws std::runtime_error when another mapper has the name, with what to do; or when the bus
  ///   cannot be opened
  MapNameClaim(const std::string& lcm_url, const std::string& map_name);

 private:
  void hear(const Heartbeat& heartbeat);
  void send_when_due();

  const std::string map_name_;
  const std::int64_t number_;
  Bus bus_;
  std::int64_t next_us_ = 0;            // when to send the next heartbeat
  std::atomic<std::int64_t> other_{0};  // the session, or the number, of another mapper
  std::optional<BusThread> thread_;     // last: it uses the rest
};

}  // namespace kintsugi::mapper

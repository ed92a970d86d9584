#pragma once
// A synthetic map as the processes would have put it on the bus.

#include <filesystem>

#include "lcmtypes/bus.hpp"
#include "tests/viewer/synthetic_room.hpp"

namespace kintsugi::viewer {

struct Recorded {
  bool updates = true;              ///< as with a segmenter running
  std::int64_t session_offset = 0;  ///< added to the map's and the segmenter's sessions
};

/// Writes the messages of `map` in the order of their device time to an LCM log, as lcm-logger
/// would have; `append` goes on where the log ends. Throws std::runtime_error.
void write_log(const std::filesystem::path& path, const SyntheticMap& map,
               const Recorded& recorded = {}, bool append = false);

/// Publishes the same messages, paced.
void publish(Bus& bus, const SyntheticMap& map);

}  // namespace kintsugi::viewer

#pragma once
// Where known objects are, from what a detector on the bus repeats.

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

struct FoundObjects {
  std::string map_name;
  std::int64_t map_session = 0;   ///< of the mapper; 0: the detector has no map yet
  std::int64_t session = 0;       ///< of the detector
  std::int64_t newest_utime = 0;  ///< device time of the newest slice that it has looked at
  std::vector<ObjectDetection> detections;  ///< also those that are gone; by ascending number
  std::string dropped;  ///< which messages were not valid, for a person; empty: all were
};

/// Listens until all detections were heard, which takes about a second.
/// @param lcm_url empty: the default bus
/// @param map_name empty: the first that is heard
/// @throws std::runtime_error when no detector is heard within `timeout`
FoundObjects ask_detector(const std::string& lcm_url, const std::string& map_name,
                          std::chrono::duration<double> timeout);

/// Only the detections of objects with this name; empty: of all.
void keep_named(const std::string& name, FoundObjects& found);

/// A detection that is not gone.
bool any_present(const FoundObjects& found);

}  // namespace kintsugi::segmenter

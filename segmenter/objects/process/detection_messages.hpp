#pragma once
// Detections for others: as messages, as JSON, as a table.

#include <cstdint>
#include <filesystem>
#include <string>

#include "lcmtypes/object_messages.hpp"
#include "segmenter/objects/detection/detector.hpp"

namespace kintsugi::segmenter {

/// Which map, and which run of a detector.
struct DetectionSource {
  std::string map;  ///< name of the map, or the file
  std::int64_t map_session = 0;
  std::int64_t session = 0;
  std::int64_t utime = 0;  ///< device time of the newest slice looked at, microseconds
};

ObjectDetection message_of(const Detection& detection, const Detector& detector,
                           const DetectionSource& source);

/// {"map": ..., "detections": [...]}, without those that are gone; the keys are in
/// segmenter/objects/README.md.
std::string detections_json(const Detector& detector, const DetectionSource& source);

/// A line for each detection that is not gone, below a line of titles.
std::string detections_text(const Detector& detector);

}  // namespace kintsugi::segmenter

#pragma once
// How soon a detector tells of an object, from the log of a live run.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kintsugi::segmenter {

/// Of a detection that holds at the end; times as the log has them, seconds.
struct DetectionTime {
  std::int32_t detection = 0;
  std::string name;
  double told_s = 0.0;  ///< first told where it is in the end
  /// The last patch came that changed the points of the map in the box of the object.
  double last_patch_s = 0.0;
  /// From then on nine tenths and more of the points that are in the box in the end were there.
  double whole_s = 0.0;

  /// From the last patch; 0 where it was told before.
  [[nodiscard]] double delay_s() const;
  /// From when most of it was in the map; 0 where it was told before.
  [[nodiscard]] double delay_of_whole_s() const;
};

struct DetectionTimes {
  std::string source;  ///< the file
  std::vector<DetectionTime> detections;
  /// Of a core, as the detector told before the last slice: in the minute before, or since its
  /// start. Nothing: it told nothing.
  std::optional<double> cpu_share;
  std::vector<std::string> remarks;  ///< what a reader of the results must know
  bool is_whole = true;              ///< false: the log is damaged or lacks messages

  [[nodiscard]] std::optional<double> delay_s(double quantile) const;
  [[nodiscard]] std::optional<double> delay_of_whole_s(double quantile) const;
};

/// Reads CLOUD_SLICE, OBJECT_DETECTION and DETECTOR_STATUS from a log of the bus. Of several
/// detectors the last one counts.
/// @throws std::runtime_error when `path` cannot be read, is no LCM log, or has no detections
DetectionTimes read_detection_times(const std::filesystem::path& path);

/// A line for each detection, and the median and the 99th percentile.
std::string to_text(const DetectionTimes& times);
std::string to_json(const DetectionTimes& times);

}  // namespace kintsugi::segmenter

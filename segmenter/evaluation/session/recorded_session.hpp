#pragma once
// What an evaluation replays: the slices of one mapper session.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/map/slice_sequencer.hpp"
#include "segmenter/tools/cloud_input.hpp"

namespace kintsugi::segmenter {

struct RecordedSession {
  std::string source;             ///< the file
  std::vector<SliceGroup> steps;  ///< one run of an engine each; at least one
  std::int64_t num_slices = 0;    ///< each once, however often it was corrected
  bool has_times = false;         ///< the slices' utime means something
  /// Of a labelled cloud: the segment_id of each point, of each slice; else empty.
  std::vector<std::vector<std::uint32_t>> segment_ids;

  /// From the first camera pose (without poses: from the first slice) to the last slice.
  std::optional<double> build_time_s;
  std::optional<double> path_length_m;  ///< of the camera
  std::vector<std::string> remarks;     ///< what a reader of the results must know
  bool is_whole = true;                 ///< false: the file is damaged or lacks slices

  [[nodiscard]] float resolution_m() const { return steps.front().slices.front().resolution_m; }
  /// The newest revision of each slice, by ascending id.
  [[nodiscard]] std::vector<const CloudSlice*> newest_slices() const;
  [[nodiscard]] std::int64_t num_points() const;  ///< of these, rejected ones included
};

/// When all its slices are there, microseconds.
std::int64_t ready_us(const SliceGroup& step);

/// Reads CLOUD_SLICE and CAMERA_POSE from an LCM log, in any order of arrival and
/// with duplicates. Slices and corrections are put in order as kintsugi-segmenter does
/// (SliceSequencer). Of several sessions the one with most slices is taken, of equal ones the
/// first. What can be read of a damaged log is taken; is_whole tells.
/// @throws std::runtime_error when `path` cannot be read, is no LCM log or holds no points
RecordedSession read_session_log(const std::filesystem::path& path);

/// Reads a PLY file (read_cloud()): its points by slice_id, without it as a single slice. Has
/// neither times nor a path.
/// @throws std::runtime_error as read_cloud()
RecordedSession read_session_cloud(const std::filesystem::path& path,
                                   const CloudInputConfig& config);

}  // namespace kintsugi::segmenter

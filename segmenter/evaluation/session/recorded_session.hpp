#pragma once
// The input of an evaluation: the slices of one mapper session, in the order they are segmented.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/map/slice_sequencer.hpp"

namespace kintsugi::segmenter {

struct RecordedSession {
  std::string source;             ///< the file
  std::vector<SliceGroup> steps;  ///< one run of an engine each; at least one
  std::int64_t num_slices = 0;    ///< each once, however often it was corrected
  bool has_times = false;         ///< the slices have valid times
  /// Of a labelled cloud: the segment_id of each point, of each slice; else empty.
  std::vector<std::vector<std::uint32_t>> segment_ids;

  /// From the first camera pose (without poses: from the first slice) to the last slice.
  std::optional<double> build_time_s;
  std::optional<double> path_length_m;  ///< of the camera
  /// Of the segmenter that was on the bus when it was recorded, as far as its statuses tell.
  std::optional<std::int64_t> segments_of_run;
  std::vector<std::string> remarks;  ///< what a reader of the results must know
  bool is_whole = true;              ///< false: the file is damaged or lacks slices

  float resolution_m() const { return steps.front().slices.front().resolution_m; }
  /// The newest revision of each slice, by ascending id.
  std::vector<const CloudSlice*> newest_slices() const;
  std::int64_t num_points() const;  ///< of these, rejected ones included
};

/// The time at which the last slice of the step was taken, microseconds.
std::int64_t ready_us(const SliceGroup& step);

}  // namespace kintsugi::segmenter

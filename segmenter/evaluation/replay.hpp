#pragma once
// Segments a session slice by slice and measures it.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/engine.hpp"

namespace kintsugi::segmenter {

/// One run of an engine.
struct SliceRun {
  std::int32_t slice_index = 0;  ///< in the session
  std::int64_t map_points = 0;   ///< accepted, after this slice
  double engine_ms = 0.0;        ///< wall time of the segmentation
  double ids_ms = 0.0;           ///< wall time of following the segment ids; 0 for `batch`
  RunStatistics statistics;
};

/// A session through one engine.
struct Replay {
  std::string mode;
  std::vector<SliceRun> runs;      ///< ascending; of every slice unless `batch` left some out
  std::vector<PointIndex> labels;  ///< canonical_labels() after the last slice
  std::int64_t num_rejected = 0;   ///< points that no engine sees
  std::int64_t resident_growth_bytes = 0;  ///< memory of the process, points included: end - begin
};

/// How far a replay is.
struct ReplayProgress {
  std::string mode;
  std::int32_t slice = 0;  ///< that were done, from 1
  std::int32_t num_slices = 0;
  std::int64_t map_points = 0;
  double last_ms = 0.0;
  double rest_s = 0.0;  ///< estimated, of this mode
};
using OnReplayProgress = std::function<void(const ReplayProgress&)>;

/// Replays `slices`, which have distinct ids, through the engine of `mode`, one run for each.
/// @throws std::invalid_argument for an unknown mode and for an invalid config
Replay replay_incrementally(std::span<const CloudSlice> slices, const std::string& mode,
                            const EngineConfig& config, const OnReplayProgress& on_progress = {});

/// Batch as the paper times it: after every `every`-th slice (>= 1), and after the last, a new
/// engine segments all points so far from scratch.
/// @throws std::invalid_argument for an invalid config or `every`
Replay replay_batch(std::span<const CloudSlice> slices, int every, const EngineConfig& config,
                    const OnReplayProgress& on_progress = {});

}  // namespace kintsugi::segmenter

#pragma once
// Segments a session slice by slice and measures it.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "segmenter/map/slice_sequencer.hpp"

namespace kintsugi::segmenter {

/// One run of an engine, measured.
struct MeasuredRun {
  std::int32_t step = 0;        ///< of the session
  std::int64_t map_points = 0;  ///< accepted, after it
  double engine_ms = 0.0;       ///< wall time of the segmentation
  double engine_cpu_ms = 0.0;   ///< of all threads of the process
  double ids_ms = 0.0;          ///< wall time of following the segment ids; 0 for `batch`
  RunStatistics statistics;
};

/// A session through one engine.
struct Replay {
  std::string mode;
  std::vector<MeasuredRun> runs;  ///< ascending; of every step unless `batch` left some out
  /// The component of each accepted point at the end, by ascending slice id and index in it; named
  /// 0, 1, ... by their first points. Comparable whatever was corrected on the way.
  std::vector<std::uint32_t> labels;
  std::int64_t resident_growth_bytes = 0;  ///< memory of the process, points included: end - begin
};

/// How far a replay is.
struct ReplayProgress {
  std::string mode;
  std::int32_t step = 0;  ///< that were done, from 1
  std::int32_t num_steps = 0;
  std::int64_t map_points = 0;
  double last_ms = 0.0;
  double rest_s = 0.0;  ///< estimated, of this mode
};
using OnReplayProgress = std::function<void(const ReplayProgress&)>;

/// Replays `steps`, in order and of one resolution, through the engine of `mode`.
/// @throws std::invalid_argument for an unknown mode and for an invalid config
Replay replay_incrementally(std::span<const SliceGroup> steps, const std::string& mode,
                            const EngineConfig& config, const OnReplayProgress& on_progress = {});

/// Batch as the paper times it: after every `every`-th step (>= 1), and after the last, a new
/// engine segments all points so far from scratch.
/// @throws std::invalid_argument for an invalid config or `every`
Replay replay_batch(std::span<const SliceGroup> steps, int every, const EngineConfig& config,
                    const OnReplayProgress& on_progress = {});

}  // namespace kintsugi::segmenter

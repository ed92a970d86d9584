#pragma once
// Times and memory of the engines over a recorded session.

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

/// A session segmented by one engine, step by step.
struct MeasuredSession {
  std::string mode;
  std::vector<MeasuredRun> runs;  ///< ascending; of every step unless `batch` left some out
  /// The component of each accepted point at the end, by ascending slice id and index in it; named
  /// 0, 1, ... by their first points. Comparable whatever was corrected on the way.
  std::vector<std::uint32_t> labels;
  std::int64_t resident_growth_bytes = 0;  ///< memory of the process, points included: end - begin
};

/// How far a measurement is.
struct MeasurementProgress {
  std::string mode;
  std::int32_t step = 0;  ///< number of steps done
  std::int32_t num_steps = 0;
  std::int64_t map_points = 0;
  double last_ms = 0.0;
  double rest_s = 0.0;  ///< estimated, of this mode
};
using OnMeasurementProgress = std::function<void(const MeasurementProgress&)>;

/// Segments `steps`, in order and of one resolution, with the engine of `mode`, and measures it.
/// @throws std::invalid_argument for an unknown mode and for an invalid config
MeasuredSession measure_incremental(std::span<const SliceGroup> steps, const std::string& mode,
                                    const EngineConfig& config,
                                    const OnMeasurementProgress& on_progress = {});

/// Batch as the paper times it: after every `every`-th step (>= 1), and after the last, a new
/// engine segments all points so far from scratch.
/// @throws std::invalid_argument for an invalid config or `every`
MeasuredSession measure_batch(std::span<const SliceGroup> steps, int every,
                              const EngineConfig& config,
                              const OnMeasurementProgress& on_progress = {});

}  // namespace kintsugi::segmenter

#pragma once
// One run of the pipeline over a disturbed recording, and its result for each frame.

#include <optional>
#include <vector>

#include "mapper/core/mapper_pipeline.hpp"
#include "tests/bench/recovery_disturbance.hpp"
#include "tests/bench/recovery_recording.hpp"

namespace kintsugi::mapper::bench {

struct FrameOutcome {
  PlannedFrame planned;
  TrackingResult tracking;  ///< its pose as corrected at the end of the run
  bool located = false;
  int part = 0;             ///< of the map, at the end of the run
  double view_known = 0.0;  ///< share of the valid pixels of the frame that were fused before, 0..1
  double frame_ms = 0.0;    ///< wall time of process()
};

/// Plays the plan. `X_WC_reference`, indexed by frame of the recording, are the poses at which a
/// view is compared with the map; for frames without one `view_known` is 0.
std::vector<FrameOutcome> run_plan(const Recording& recording, const Plan& plan, bool with_color,
                                   const MapperPipeline::Config& config,
                                   const std::vector<std::optional<Pose>>& X_WC_reference);

/// The estimated pose of each frame when the recording is played without a disturbance.
std::vector<std::optional<Pose>> undisturbed_path(const Recording& recording, bool with_color,
                                                  const MapperPipeline::Config& config);

}  // namespace kintsugi::mapper::bench

#pragma once
// One run of the pipeline over a disturbed recording, and what came of it.

#include <optional>
#include <vector>

#include "mapper/core/mapper_pipeline.hpp"
#include "tests/bench/recovery_disturbance.hpp"
#include "tests/bench/recovery_recording.hpp"

namespace kintsugi::mapper::bench {

struct FrameOutcome {
  PlannedFrame planned;
  TrackingResult tracking;
  bool located = false;
  double view_known = 0.0;  ///< share of the frame's valid pixels that the map shows already, 0..1
  double frame_ms = 0.0;    ///< wall time of process()
};

/// Plays the plan. `X_WC_reference`, by frame of the recording, are the poses that a view is
/// compared with the map at; frames without one count as not known.
std::vector<FrameOutcome> run_plan(const Recording& recording, const Plan& plan, bool with_color,
                                   const MapperPipeline::Config& config,
                                   const std::vector<std::optional<Pose>>& X_WC_reference);

/// Where each frame is located when the recording is played as it is.
std::vector<std::optional<Pose>> undisturbed_path(const Recording& recording, bool with_color,
                                                  const MapperPipeline::Config& config);

}  // namespace kintsugi::mapper::bench

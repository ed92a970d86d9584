#pragma once

#include "segmenter/core/batch/batch_segmentation.hpp"
#include "segmenter/core/exact/state.hpp"

namespace kintsugi::segmenter::exact {

/// Builds the state of the engine by Algorithm 1 over the points of `rows`, in little more than the
/// time of Algorithm 1 alone. `state` must be clear, and all other vertices marked as gone.
BatchStatistics build_state(const PointRows& rows, const EngineConfig& config, State& state);

}  // namespace kintsugi::segmenter::exact

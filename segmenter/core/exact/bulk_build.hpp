#pragma once

#include <span>

#include "segmenter/core/batch/batch_segmentation.hpp"
#include "segmenter/core/exact/state.hpp"

namespace kintsugi::segmenter::exact {

/// Builds the state of the engine from scratch by Algorithm 1 over `points`, in little more than
/// its own time. `state` is clear; is_gone of all others.
BatchStatistics build_state(const PointCloud& cloud, std::span<const PointIndex> points,
                            const EngineConfig& config, State& state);

}  // namespace kintsugi::segmenter::exact

#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "segmenter/core/make_engine.hpp"
#include "tests/fuzz/scenario.hpp"

namespace kintsugi::segmenter::fuzz {

using EngineFactory = std::function<std::unique_ptr<SegmentationEngine>(
    const PointCloud& cloud, const EngineConfig& config)>;

/// The engine that make_engine() calls `mode`.
EngineFactory engine_factory(const std::string& mode);

struct Outcome {
  std::size_t num_steps = 0;           ///< checked, including one that failed
  std::size_t num_rebuilt = 0;         ///< steps in which the engine rebuilt its state
  std::optional<std::string> failure;  ///< what was wrong after the last of them
};

/// Runs an engine through the scenario and checks it after every step, up to the first failure. An
/// exception is a failure, too.
Outcome run_scenario(const Scenario& scenario, const EngineFactory& make_engine);

}  // namespace kintsugi::segmenter::fuzz

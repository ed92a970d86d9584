#pragma once

#include <functional>

#include "tests/fuzz/run_scenario.hpp"

namespace kintsugi::segmenter::fuzz {

/// Calls `run` in a process of its own, so that an engine that crashes or never returns is a
/// failure like any other: "died: Segmentation fault", "not done after 60 s". Only one thread may
/// be alive in this process. Throws std::system_error when there can be no other process.
Outcome run_isolated(const std::function<Outcome()>& run, int timeout_s);

}  // namespace kintsugi::segmenter::fuzz

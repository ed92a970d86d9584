#pragma once

#include <functional>

#include "tests/fuzz/run_scenario.hpp"

namespace kintsugi::segmenter::fuzz {

/// Calls `run` in a process of its own, so that an engine that crashes or never returns is a
/// failure like any other: "died: Segmentation fault", "not done after 60 s". This process must
/// have only one thread.
/// @throws std::system_error when no process can be started
Outcome run_isolated(const std::function<Outcome()>& run, int timeout_s);

}  // namespace kintsugi::segmenter::fuzz

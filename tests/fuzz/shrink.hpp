#pragma once

#include <functional>

#include "tests/fuzz/scenario.hpp"

namespace kintsugi::segmenter::fuzz {

/// Leaves out steps and points as long as `fails` still holds, in ever smaller pieces, and gives up
/// after `max_trials` calls of it. `scenario` itself must fail.
Scenario shrink(Scenario scenario, const std::function<bool(const Scenario&)>& fails,
                int max_trials);

}  // namespace kintsugi::segmenter::fuzz

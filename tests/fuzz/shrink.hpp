#pragma once

#include <functional>

#include "tests/fuzz/scenario.hpp"

namespace kintsugi::segmenter::fuzz {

/// Removes steps and points, in ever smaller pieces, as long as `fails` still holds. Stops after
/// `max_trials` calls of it. `scenario` itself must fail.
Scenario shrink(Scenario scenario, const std::function<bool(const Scenario&)>& fails,
                int max_trials);

}  // namespace kintsugi::segmenter::fuzz

#pragma once

#include <algorithm>
#include <chrono>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi {

/// When a wait of `timeout` that begins now ends; after a year at the latest, because the clock has
/// no time that never comes.
/// @throws std::invalid_argument when it is negative or no number
inline std::chrono::steady_clock::time_point deadline_after(std::chrono::duration<double> timeout) {
  require(timeout.count() >= 0.0, "timeout", timeout.count(), ">= 0 seconds");
  constexpr std::chrono::duration<double> kLongest = std::chrono::years(1);
  using Clock = std::chrono::steady_clock;
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::min(timeout, kLongest));
}

}  // namespace kintsugi

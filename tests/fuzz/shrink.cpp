#include "tests/fuzz/shrink.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace kintsugi::segmenter::fuzz {
namespace {

Scenario without_steps(const Scenario& scenario, std::size_t first, std::size_t count) {
  Scenario smaller = scenario;
  const auto begin = smaller.steps.begin() + static_cast<std::ptrdiff_t>(first);
  smaller.steps.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
  return smaller;
}

/// Without the points [first, first + count) of the pool; the later ones move up.
Scenario without_points(const Scenario& scenario, std::size_t first, std::size_t count) {
  Scenario smaller = scenario;
  const auto begin = smaller.pool.begin() + static_cast<std::ptrdiff_t>(first);
  smaller.pool.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
  for (Step& step : smaller.steps) {
    for (std::vector<PoolIndex>* const points : {&step.add, &step.remove}) {
      std::erase_if(*points, [&](PoolIndex i) { return i >= first && i < first + count; });
      for (PoolIndex& i : *points) {
        if (i >= first) i -= static_cast<PoolIndex>(count);
      }
    }
  }
  return smaller;
}

/// Leaves out pieces of half the length, then of a quarter and so on down to single ones.
template <typename Length, typename Without, typename Fails>
bool leave_out(Scenario& scenario, Length length, Without without, Fails fails) {
  bool smaller = false;
  for (std::size_t piece = std::max<std::size_t>(length(scenario) / 2, 1); piece > 0; piece /= 2) {
    for (std::size_t first = 0; first < length(scenario);) {
      const std::size_t count = std::min(piece, length(scenario) - first);
      Scenario trial = without(scenario, first, count);
      if (fails(trial)) {
        scenario = std::move(trial);
        smaller = true;
      } else {
        first += count;
      }
    }
  }
  return smaller;
}

}  // namespace

Scenario shrink(Scenario scenario, const std::function<bool(const Scenario&)>& fails,
                int max_trials) {
  const auto still_fails = [&](const Scenario& trial) { return max_trials-- > 0 && fails(trial); };
  const auto num_steps = [](const Scenario& s) { return s.steps.size(); };
  const auto num_points = [](const Scenario& s) { return s.pool.size(); };
  bool smaller = true;
  while (smaller) {
    smaller = leave_out(scenario, num_steps, without_steps, still_fails);
    smaller |= leave_out(scenario, num_points, without_points, still_fails);
  }
  return scenario;
}

}  // namespace kintsugi::segmenter::fuzz

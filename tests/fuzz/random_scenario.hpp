#pragma once

#include <cstdint>
#include <span>

#include "tests/fuzz/scenario.hpp"

namespace kintsugi::segmenter::fuzz {

struct ScenarioBounds {
  std::size_t min_points = 20;  ///< of the cloud before anything moves
  std::size_t max_points = 3000;
  std::size_t max_steps = 40;
};

/// A random scenario over a random_cloud(): slices of any size come; points leave one by one, many
/// at once, a ball of them, or all; they come back; they move, one by one, as slices that are
/// replaced, or as a rigid piece, which may later move back; two points are in the same place;
/// nothing happens. Several of these may happen in one update.
Scenario random_scenario(std::uint64_t seed, const ScenarioBounds& bounds,
                         std::span<const CloudPoint> map_W);

}  // namespace kintsugi::segmenter::fuzz

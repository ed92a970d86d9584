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

/// What happens to a map in its life, drawn from `seed`: slices come in portions of any size;
/// points leave one by one, many at once, a ball of them, or all; they come back to their place;
/// they move, alone, as slices that are replaced, or as a rigid piece, which later moves back; a
/// place is taken twice; nothing happens. Several of these may fall into one update. The cloud is
/// one of random_cloud().
Scenario random_scenario(std::uint64_t seed, const ScenarioBounds& bounds,
                         std::span<const CloudPoint> map_W);

}  // namespace kintsugi::segmenter::fuzz

#pragma once

#include <cstdint>
#include <iosfwd>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter::fuzz {

/// A point of a scenario, whether it is in the map or not. A point that moves is two of them.
using PoolIndex = std::uint32_t;

/// The points that come and go between two updates of the engine.
struct Step {
  std::vector<PoolIndex> add;
  std::vector<PoolIndex> remove;
};

/// Everything that happens to a map. To add a point that is in the map, or to remove one that is
/// not, has no effect. So any points and steps can be left out to find a smaller scenario.
struct Scenario {
  EngineConfig config;
  std::size_t slice_points = 1;  ///< consecutive points of the pool that share a slice
  std::vector<CloudPoint> pool;
  std::vector<Step> steps;
};

/// Writes a scenario as text, exact to the bit.
void write_scenario(std::ostream& out, const Scenario& scenario);
/// Reads it.
/// @throws std::runtime_error naming what was expected
Scenario read_scenario(std::istream& in);

}  // namespace kintsugi::segmenter::fuzz

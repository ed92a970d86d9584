#pragma once

#include <cstdint>
#include <iosfwd>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/engine/engine.hpp"

namespace kintsugi::segmenter::fuzz {

/// Names a point of a scenario, in or out of the map. A point that moves is two of them.
using PoolIndex = std::uint32_t;

/// What comes and goes between two updates of the engine.
struct Step {
  std::vector<PoolIndex> add;
  std::vector<PoolIndex> remove;
};

/// All that happens to a map, decided beforehand. A step that adds a point that is in, or removes
/// one that is not, leaves it alone: any points and any steps may be left out to find a smaller
/// scenario.
struct Scenario {
  EngineConfig config;
  std::size_t slice_points = 1;  ///< consecutive points of the pool that share a slice
  std::vector<CloudPoint> pool;
  std::vector<Step> steps;
};

/// As text, exact to the bit; read_scenario() takes it back and throws std::runtime_error, naming
/// what it expected, when it is no scenario.
void write_scenario(std::ostream& out, const Scenario& scenario);
Scenario read_scenario(std::istream& in);

}  // namespace kintsugi::segmenter::fuzz

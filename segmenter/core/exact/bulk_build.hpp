#pragma once

#include <cstdint>
#include <span>

#include "segmenter/core/edge.hpp"
#include "segmenter/core/exact/state.hpp"

namespace kintsugi::segmenter::exact {

/// Builds the state of the engine from scratch by Algorithm 1 over all `edges` (undirected, each
/// once, weights below T + k, any order), in little more than its own time. `state` has vertices
/// as they are when new, is_gone for those that are not in the cloud, and nothing else. Returns the
/// number of joins.
std::int64_t build_state(std::span<const Edge> edges, const JoinRule& rule, State& state);

}  // namespace kintsugi::segmenter::exact

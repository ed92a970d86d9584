#pragma once

#include <vector>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/graph/edge.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"

namespace kintsugi::segmenter {

/// Algorithm 2 for a whole cloud: one undirected edge (i < j) for each two neighbours in `index`
/// with a weight below config.max_weight(), in no particular order. A threshold theta never exceeds
/// that, so heavier edges cannot join anything: the partition is that of all edges.
std::vector<Edge> build_graph(const PointCloud& cloud, const NeighbourIndex& index,
                              const EngineConfig& config);

}  // namespace kintsugi::segmenter

#pragma once

#include <vector>

#include "segmenter/core/graph/edge.hpp"
#include "segmenter/core/graph/edge_weight.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"

namespace kintsugi::segmenter {

/// Algorithm 2 for a whole cloud: one undirected edge (i < j) for each two neighbours in `index`
/// whose weight is below `max_weight`, in no particular order. With EngineConfig::max_weight() the
/// partition is that of all edges.
std::vector<Edge> build_graph(const PointCloud& cloud, const NeighbourIndex& index,
                              const EdgeWeight& weight_of, double max_weight);

}  // namespace kintsugi::segmenter

#include "segmenter/core/graph/graph.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include "segmenter/core/graph/edge_weight.hpp"

namespace kintsugi::segmenter {

std::vector<Edge> build_graph(const PointCloud& cloud, const NeighbourIndex& index,
                              const EngineConfig& config) {
  const double max_weight = config.max_weight();
  oneapi::tbb::enumerable_thread_specific<std::vector<Edge>> found;
  index.visit_all([&](PointIndex i, std::span<const PointIndex> neighbours) {
    std::vector<Edge>& edges = found.local();
    for (const PointIndex j : neighbours) {
      if (j < i) continue;  // the other end inserts it
      const float weight = edge_weight(cloud[i], cloud[j], config.color_weight);
      if (weight < max_weight) edges.push_back({weight, i, j});
    }
  });
  std::vector<Edge> edges;
  for (std::vector<Edge>& part : found) {
    if (edges.empty()) {
      edges.swap(part);
    } else {
      edges.insert(edges.end(), part.begin(), part.end());
    }
  }
  return edges;
}

}  // namespace kintsugi::segmenter

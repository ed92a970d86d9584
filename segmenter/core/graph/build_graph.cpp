#include "segmenter/core/graph/build_graph.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>

namespace kintsugi::segmenter {

std::vector<Edge> build_graph(const PointCloud& cloud, const NeighbourIndex& index,
                              const EdgeWeight& weight_of, double max_weight) {
  oneapi::tbb::enumerable_thread_specific<std::vector<Edge>> found;
  index.visit_all([&](PointIndex i, std::span<const PointIndex> neighbours) {
    std::vector<Edge>& edges = found.local();
    for (const PointIndex j : neighbours) {
      if (j < i) continue;  // inserted when the other end is visited
      const float weight = weight_of(cloud[i], cloud[j]);
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

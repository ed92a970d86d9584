#include "segmenter/core/felzenszwalb.hpp"

#include <oneapi/tbb/parallel_sort.h>

namespace kintsugi::segmenter {

std::int64_t join_segments(std::vector<Edge> edges, SegmentForest& forest) {
  oneapi::tbb::parallel_sort(edges.begin(), edges.end(), AscendingWeight());
  std::int64_t num_joins = 0;
  for (const Edge& edge : edges) num_joins += forest.join(edge.i, edge.j, edge.weight);
  return num_joins;
}

}  // namespace kintsugi::segmenter

#include "segmenter/core/fragments/edge_order.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace kintsugi::segmenter {

void EdgeOrder::sort(std::span<Edge> edges) const {
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.weight < b.weight; });
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t last = first + 1;
    while (last < edges.size() && edges[last].weight == edges[first].weight) ++last;
    if (last - first > 1) sort_ties(edges.subspan(first, last - first));
    first = last;
  }
}

/// Looks up each id only once: a flat surface has many edges of one weight.
void EdgeOrder::sort_ties(std::span<Edge> edges) const {
  std::vector<std::pair<Ids, Edge>> by_ids;
  by_ids.reserve(edges.size());
  for (const Edge& edge : edges) by_ids.emplace_back(ids_of(edge), edge);
  std::sort(by_ids.begin(), by_ids.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t k = 0; k < edges.size(); ++k) edges[k] = by_ids[k].second;
}

}  // namespace kintsugi::segmenter

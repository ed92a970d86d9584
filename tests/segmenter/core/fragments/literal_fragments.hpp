#pragma once
// The fragment step, transcribed line by line: slow, and independent of the engines, which are
// compared with it.

#include <algorithm>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "segmenter/core/engine/engine.hpp"
#include "tests/segmenter/core/literal_segmentation.hpp"

namespace kintsugi::segmenter::testing {

/// The labels of `partition`, a name for each point of `live`, once of all edges between
/// neighbours, in ascending order of weight, then of the two PointIds, each has joined its two
/// components if either has fewer than `limit` points. Each component is named by the smallest
/// place in `live`.
inline std::vector<PointIndex> literal_fragment_step(const PointCloud& cloud,
                                                     std::span<const PointIndex> live,
                                                     std::span<const ComponentId> partition,
                                                     float r, std::int64_t limit, double lambda) {
  std::vector<std::tuple<float, PointId, PointId, std::size_t, std::size_t>> edges;
  for (std::size_t a = 0; a < live.size(); ++a) {
    for (std::size_t b = a + 1; b < live.size(); ++b) {
      const CloudPoint& p = cloud[live[a]];
      const CloudPoint& q = cloud[live[b]];
      if (!literal_neighbours(p, q, r)) continue;
      const PointId id_a = cloud.id_of(live[a]);
      const PointId id_b = cloud.id_of(live[b]);
      const float weight = std::min(literal_weight(p, q, lambda), literal_weight(q, p, lambda));
      edges.emplace_back(weight, std::min(id_a, id_b), std::max(id_a, id_b), a, b);
    }
  }
  std::sort(edges.begin(), edges.end());

  std::map<ComponentId, std::vector<std::size_t>> members;
  for (std::size_t k = 0; k < live.size(); ++k) members[partition[live[k]]].push_back(k);
  std::vector<ComponentId> component_of(live.size());
  for (const auto& [name, points] : members) {
    for (const std::size_t k : points) component_of[k] = name;
  }
  for (const auto& [weight, first, second, a, b] : edges) {
    const ComponentId into = component_of[a];
    const ComponentId from = component_of[b];
    if (into == from) continue;
    const auto is_small = [&](ComponentId c) { return std::ssize(members[c]) < limit; };
    if (!is_small(into) && !is_small(from)) continue;
    for (const std::size_t k : members[from]) {
      component_of[k] = into;
      members[into].push_back(k);
    }
    members.erase(from);
  }
  std::vector<PointIndex> labels(live.size());
  for (const auto& [name, points] : members) {
    const auto smallest = *std::min_element(points.begin(), points.end());
    for (const std::size_t k : points) labels[k] = static_cast<PointIndex>(smallest);
  }
  return labels;
}

}  // namespace kintsugi::segmenter::testing

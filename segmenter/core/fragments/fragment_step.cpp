#include "segmenter/core/fragments/fragment_step.hpp"

#include <cstddef>
#include <vector>

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include "segmenter/core/fragments/edge_order.hpp"
#include "segmenter/core/graph/edge_buckets.hpp"

namespace kintsugi::segmenter {
namespace {

using EdgesByThread = oneapi::tbb::enumerable_thread_specific<EdgeBuckets>;

/// The edges between two components at least one of which is small. No other can join anything.
EdgesByThread find_edges(const PointRows& rows, std::span<const ComponentId> components,
                         const FragmentForest& forest, EdgeWeight weight_of) {
  struct Component {
    ComponentId name;
    bool is_small;
  };
  std::vector<Component> component_at(rows.points().size());
  for (std::size_t k = 0; k < component_at.size(); ++k) {
    const ComponentId name = components[rows.points()[k].index];
    component_at[k] = {name, forest.is_small(name)};
  }
  EdgesByThread found;
  oneapi::tbb::parallel_for(std::size_t{0}, rows.num_rows(), [&](std::size_t row) {
    EdgeBuckets& edges = found.local();
    const auto keep = [&](PointRows::Slot a, PointRows::Slot b) {
      const Component& p = component_at[a];
      const Component& q = component_at[b];
      return p.name != q.name && (p.is_small || q.is_small);
    };
    rows.for_each_pair(row, keep, [&](PointRows::Slot a, PointRows::Slot b) {
      const PointRows::Point& p = rows.points()[a];
      const PointRows::Point& q = rows.points()[b];
      edges.add({weight_of(p, q), p.index, q.index});
    });
  });
  return found;
}

}  // namespace

void join_fragments(const PointCloud& cloud, std::span<const PointIndex> points,
                    std::span<const ComponentId> components, const EngineConfig& config,
                    FragmentForest& forest, FragmentObserver& observer) {
  const PointRows rows(cloud, points, config.radius_m());
  join_fragments(cloud, rows, components, config, forest, observer);
}

void join_fragments(const PointCloud& cloud, const PointRows& rows,
                    std::span<const ComponentId> components, const EngineConfig& config,
                    FragmentForest& forest, FragmentObserver& observer) {
  EdgesByThread found = find_edges(rows, components, forest, config.edge_weight());
  const EdgeOrder order(cloud);
  const auto is_joining = [&](ComponentId a, ComponentId b) {
    return a != b && (forest.is_small(a) || forest.is_small(b));
  };
  std::vector<Edge> candidates;
  for (std::size_t bucket = 0; bucket < EdgeBuckets::kNumBuckets; ++bucket) {
    candidates.clear();
    for (EdgeBuckets& edges : found) {
      edges.take(bucket, [&](std::span<const Edge> some) {
        for (const Edge& edge : some) {
          if (is_joining(forest.find_point(edge.i), forest.find_point(edge.j))) {
            candidates.push_back(edge);
          }
        }
      });
    }
    order.sort(candidates);
    for (const Edge& edge : candidates) {
      const ComponentId i = forest.find_point(edge.i);
      const ComponentId j = forest.find_point(edge.j);
      if (!is_joining(i, j)) continue;
      const PointIndex first_point = order.first_point(edge);
      observer.joining(edge, i, j, first_point);
      forest.join(i, j, first_point);
    }
  }
}

}  // namespace kintsugi::segmenter

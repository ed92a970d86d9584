#include "segmenter/core/fragments/rebuild_clusters.hpp"

#include <cstdint>
#include <utility>

#include "segmenter/core/fragments/fragment_step.hpp"

namespace kintsugi::segmenter {
namespace {

/// Keeps the points of each small set in a circle, and adds a cluster when it reaches the limit.
class Recorder final : public FragmentObserver {
 public:
  Recorder(const BaseComponents& components, const FragmentForest& forest, Clusters& clusters)
      : components_(components),
        forest_(forest),
        clusters_(clusters),
        next_(components.of_points().size()) {
    for (PointIndex i = 0; i < next_.size(); ++i) {
      if (!components.is_in_fragment(i)) continue;
      const PointIndex first = forest.namer(components[i]);  // no sets are joined yet
      next_[i] = i == first ? i : std::exchange(next_[first], i);
    }
  }

  void joining(const Edge& edge, ComponentId root_i, ComponentId root_j,
               PointIndex /*first_point*/) override {
    const bool is_i_small = forest_.is_small(root_i);
    const bool is_j_small = forest_.is_small(root_j);
    const std::int64_t num_points =
        std::int64_t{forest_.num_points(root_i)} + forest_.num_points(root_j);
    if (is_i_small && is_j_small && num_points < components_.limit()) {
      std::swap(next_[edge.i], next_[edge.j]);  // merges the two circles
      return;
    }
    if (is_i_small) add(edge.i, Exit::along(edge));
    if (is_j_small) add(edge.j, Exit::along({edge.weight, edge.j, edge.i}));
  }

  void add(PointIndex head, const Exit& exit) {
    points_.clear();
    PointIndex i = head;
    do {
      points_.push_back(i);
      i = next_[i];
    } while (i != head);
    clusters_.add(points_, exit);
  }

 private:
  const BaseComponents& components_;
  const FragmentForest& forest_;
  Clusters& clusters_;
  GrowingArray<PointIndex> next_;
  std::vector<PointIndex> points_;
};

}  // namespace

std::vector<PointIndex> rebuild_clusters(const PointCloud& cloud, const EngineConfig& config,
                                         const BaseComponents& components, Clusters& clusters,
                                         const PointRows* rows) {
  clusters.clear();
  const std::span<const ComponentId> names = components.of_points();
  std::vector<PointIndex> points;
  points.reserve(cloud.num_live());
  for (PointIndex i = 0; i < names.size(); ++i) {
    if (names[i] != kNoComponent) points.push_back(i);
  }
  FragmentForest forest(names, components.limit());
  Recorder recorder(components, forest, clusters);
  if (rows != nullptr) {
    join_fragments(cloud, *rows, names, config, forest, recorder);
  } else {
    join_fragments(cloud, points, names, config, forest, recorder);
  }

  std::vector<PointIndex> namers(names.size());
  for (const PointIndex i : points) {
    const ComponentId root = forest.find_point(i);
    namers[i] = forest.namer(root);
    const bool has_cluster = !components.is_in_fragment(i) || clusters.of(names[i]) != kNoCluster;
    if (!has_cluster) recorder.add(i, Exit::none(namers[i]));
  }
  return namers;
}

}  // namespace kintsugi::segmenter

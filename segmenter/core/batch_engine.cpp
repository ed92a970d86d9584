#include "segmenter/core/batch_engine.hpp"

#include <cassert>

#include "segmenter/core/felzenszwalb.hpp"
#include "segmenter/core/graph.hpp"

namespace kintsugi::segmenter {

BatchEngine::BatchEngine(const PointCloud& cloud, const EngineConfig& config)
    : cloud_(cloud),
      config_(config),
      index_(make_neighbour_index(config.neighbour_search, cloud, config.radius_m())),
      forest_(config.threshold, config.scale) {}

RunStatistics BatchEngine::update(const CloudChange& change) {
  assert(change.removed.empty());
  static_cast<void>(change);
  index_->update();
  const std::vector<Edge> edges = build_graph(cloud_, *index_, config_.threshold + config_.scale);

  forest_ = SegmentForest(config_.threshold, config_.scale);
  forest_.grow(cloud_.size());
  RunStatistics statistics{.num_points = cloud_.size(), .num_iterations = 1};
  statistics.num_edges = static_cast<std::int64_t>(edges.size());
  statistics.num_joins = join_segments(edges, forest_);

  std::vector<PointIndex> roots(cloud_.size());
  for (PointIndex i = 0; i < cloud_.size(); ++i) roots[i] = forest_.find(i);
  const std::vector<PointIndex> before = std::exchange(components_, canonical_labels(roots));
  changed_.clear();
  for (PointIndex i = 0; i < cloud_.size(); ++i) {
    if (i >= before.size() || before[i] != components_[i]) changed_.push_back(i);
  }
  return statistics;
}

double BatchEngine::theta(ComponentId component) const {
  return forest_.theta_at(forest_.root(component));
}

}  // namespace kintsugi::segmenter

#include "segmenter/core/batch_engine.hpp"

#include "segmenter/core/felzenszwalb.hpp"
#include "segmenter/core/graph.hpp"

namespace kintsugi::segmenter {

BatchEngine::BatchEngine(const PointCloud& cloud, const EngineConfig& config)
    : cloud_(cloud),
      config_(config),
      index_(make_neighbour_index(config.neighbour_search, cloud, config.radius_m())),
      forest_(config.threshold, config.scale) {}

RunStatistics BatchEngine::update(const CloudChange& change) {
  index_->remove(change.removed);
  index_->insert(change.added);
  const std::vector<Edge> edges = build_graph(cloud_, *index_, config_.threshold + config_.scale);

  forest_ = SegmentForest(config_.threshold, config_.scale);
  forest_.grow(cloud_.size());
  RunStatistics statistics{.num_iterations = 1};
  statistics.num_edges = static_cast<std::int64_t>(edges.size());
  statistics.num_joins = join_segments(edges, forest_);

  const std::vector<ComponentId> before = take_over(change);
  statistics.num_points = name_components();
  changed_.clear();
  for (PointIndex i = 0; i < cloud_.size(); ++i) {
    if (components_[i] != before[i]) changed_.push_back(i);
  }
  return statistics;
}

/// Marks who is there in components_; returns the names there were, none for new points.
std::vector<ComponentId> BatchEngine::take_over(const CloudChange& change) {
  components_.resize(cloud_.size(), kNoComponent);
  for (const PointIndex i : change.removed) components_[i] = kNoComponent;
  for (const PointIndex i : change.added) components_[i] = kNoComponent;
  std::vector<ComponentId> before = components_;
  for (const PointIndex i : change.added) components_[i] = i;
  return before;
}

/// Returns the number of points there are.
std::int64_t BatchEngine::name_components() {
  std::int64_t num_points = 0;
  for (PointIndex i = 0; i < cloud_.size(); ++i) {
    if (components_[i] == kNoComponent) continue;
    components_[i] = forest_.find(i);
    ++num_points;
  }
  components_ = canonical_labels(components_);
  return num_points;
}

double BatchEngine::theta(ComponentId component) const {
  return forest_.theta_at(forest_.root(component));
}

std::size_t BatchEngine::bytes() const {
  return index_->bytes() + forest_.bytes() +
         (components_.capacity() + changed_.capacity()) * sizeof(PointIndex);
}

}  // namespace kintsugi::segmenter

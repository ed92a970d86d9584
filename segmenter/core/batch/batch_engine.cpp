#include "segmenter/core/batch/batch_engine.hpp"

#include "segmenter/core/fragments/fragment_step.hpp"
#include "segmenter/core/graph/build_graph.hpp"
#include "segmenter/core/graph/make_neighbour_index.hpp"

namespace kintsugi::segmenter {

BatchEngine::BatchEngine(const PointCloud& cloud, const EngineConfig& config)
    : cloud_(cloud), config_(config), forest_(config.threshold, config.scale) {
  if (config.neighbour_search != NeighbourSearch::kGrid) {
    index_ = make_neighbour_index(config.neighbour_search, cloud, config.radius_m());
  }
}

RunStatistics BatchEngine::update(const CloudChange& change) {
  std::vector<ComponentId> before = take_over(change);
  std::vector<PointIndex> points;
  for (PointIndex i = 0; i < cloud_.size(); ++i) {
    if (components_[i] != kNoComponent) points.push_back(i);
  }
  const BatchStatistics batch = segment(points);

  for (const PointIndex i : points) components_[i] = forest_.find(i);
  components_ = canonical_labels(components_);
  if (joins_fragments()) join_fragments_of(points);
  changed_.clear();
  for (const PointIndex i : points) {
    if (components()[i] != before[i]) changed_.push_back(i);
  }
  return {.num_edges = batch.num_edges,
          .num_joins = batch.num_joins,
          .num_points = static_cast<std::int64_t>(points.size()),
          .num_iterations = 1};
}

/// Marks the points in the cloud in components_. Returns the names before the change; kNoComponent
/// for new points.
std::vector<ComponentId> BatchEngine::take_over(const CloudChange& change) {
  if (index_ && change.moved_in_place.empty()) {
    index_->remove(change.removed);
    index_->insert(change.added);
  } else if (index_) {
    index_ = make_neighbour_index(config_.neighbour_search, cloud_, config_.radius_m());
    index_->insert(cloud_.everything().added);
  }
  components_.resize(cloud_.size(), kNoComponent);
  if (joins_fragments()) joined_.resize(cloud_.size(), kNoComponent);
  std::vector<ComponentId> before(components().begin(), components().end());
  for (const PointIndex i : change.removed) before[i] = components_[i] = kNoComponent;
  for (const PointIndex i : change.added) {
    before[i] = kNoComponent;
    components_[i] = i;
  }
  return before;
}

void BatchEngine::join_fragments_of(std::span<const PointIndex> points) {
  FragmentForest forest(components_, config_.fragment_limit());
  FragmentObserver no_observer;
  join_fragments(cloud_, points, components_, config_, forest, no_observer);
  joined_.assign(components_.size(), kNoComponent);
  for (const PointIndex i : points) joined_[i] = components_[forest.namer(forest.find_point(i))];
}

BatchStatistics BatchEngine::segment(std::span<const PointIndex> points) {
  forest_ = SegmentForest(config_.threshold, config_.scale);
  forest_.grow(cloud_.size());
  if (index_) {
    const std::vector<Edge> edges =
        build_graph(cloud_, *index_, config_.edge_weight(), config_.max_weight());
    return {.num_edges = static_cast<std::int64_t>(edges.size()),
            .num_joins = join_segments(edges, forest_)};
  }
  JoinObserver no_observer;
  return segment_points(cloud_, points, config_, forest_, no_observer);
}

double BatchEngine::theta(ComponentId component) const {
  return forest_.theta_at(forest_.root(component));
}

std::size_t BatchEngine::bytes() const {
  const std::size_t index_bytes = index_ ? index_->bytes() : 0;
  return index_bytes + forest_.bytes() +
         (components_.capacity() + joined_.capacity() + changed_.capacity()) * sizeof(PointIndex);
}

}  // namespace kintsugi::segmenter

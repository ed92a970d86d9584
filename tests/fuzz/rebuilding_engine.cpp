#include "tests/fuzz/rebuilding_engine.hpp"

#include <algorithm>
#include <utility>

#include "tests/fuzz/partition.hpp"

namespace kintsugi::segmenter::fuzz {

RunStatistics RebuildingEngine::update(const CloudChange& change) {
  is_in_.resize(cloud_.size(), false);
  for (const PointIndex i : change.removed) is_in_[i] = false;
  for (const PointIndex i : change.added) is_in_[i] = true;
  std::vector<PointIndex> live;
  std::vector<CloudPoint> points_W;
  for (PointIndex i = 0; i < cloud_.size(); ++i) {
    if (!is_in_[i]) continue;
    live.push_back(i);
    points_W.push_back(cloud_[i]);
  }
  const Partition partition = batch_partition(points_W, config_);

  std::vector<ComponentId> before = std::exchange(components_, {});
  before.resize(cloud_.size(), kNoComponent);
  for (const PointIndex i : change.added) before[i] = kNoComponent;
  components_.resize(cloud_.size(), kNoComponent);
  thetas_.resize(cloud_.size(), 0.0);
  changed_.clear();
  for (std::size_t k = 0; k < live.size(); ++k) {
    const ComponentId component = live[partition.labels[k]];
    components_[live[k]] = component;
    thetas_[component] = partition.thetas[k];
    if (before[live[k]] != component) changed_.push_back(live[k]);
  }
  return {.num_points = std::ssize(live), .num_iterations = 1};
}

}  // namespace kintsugi::segmenter::fuzz

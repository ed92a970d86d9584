#include "segmenter/core/fragments/fragment_layer.hpp"

#include <algorithm>

#include "segmenter/core/fragments/fragment_step.hpp"
#include "segmenter/core/fragments/rebuild_clusters.hpp"

namespace kintsugi::segmenter {

FragmentLayer::FragmentLayer(const PointCloud& cloud, const IncrementalEngine& base,
                             const EngineConfig& config)
    : cloud_(cloud),
      base_(base),
      config_(config),
      order_(cloud),
      components_(config.fragment_limit()),
      clusters_(components_),
      search_(cloud, base.neighbour_index(), components_, config.edge_weight()) {}

void FragmentLayer::update(const CloudChange& change, const PointRows* rows) {
  grow();
  changed_.clear();
  if (is_cheaper_to_rebuild(change)) {
    rebuild(change, rows);
  } else {
    dissolve_changed(change);
    take_over_components(change);
    dissolve_reached_by(change.added);
    find_clusters();
    label_points();
  }
  std::sort(changed_.begin(), changed_.end());
}

void FragmentLayer::grow() {
  components_.grow(cloud_.size());
  clusters_.grow(cloud_.size());
  search_.grow(cloud_.size());
  labels_.resize(cloud_.size(), kNoComponent);
}

bool FragmentLayer::is_cheaper_to_rebuild(const CloudChange& change) const {
  if (!change.moved_in_place.empty()) return true;
  const auto num_changed = static_cast<double>(base_.changed().size() + change.removed.size());
  return num_changed > config_.rebuild_share * static_cast<double>(cloud_.num_live());
}

void FragmentLayer::rebuild(const CloudChange& change, const PointRows* rows) {
  take_over_components(change);
  const std::vector<PointIndex> namers =
      rebuild_clusters(cloud_, config_, components_, clusters_, rows);
  for (PointIndex i = 0; i < labels_.size(); ++i) {
    if (components_[i] != kNoComponent) set_label(i, components_[namers[i]]);
  }
}

void FragmentLayer::dissolve(ClusterId cluster) {
  if (cluster != kNoCluster) clusters_.dissolve(cluster, loose_);
}

/// Dissolves the clusters that lose or gain points, that have a component whose name changes, and
/// those whose exits lead to removed points. components_ must still have the old names.
void FragmentLayer::dissolve_changed(const CloudChange& change) {
  loose_.clear();
  const auto dissolve_at = [&](PointIndex point) {
    if (components_[point] != kNoComponent) dissolve(clusters_.of(components_[point]));
  };
  for (const PointIndex i : change.removed) {
    dissolve_at(i);
    while (clusters_.first_to(i) != kNoCluster) dissolve(clusters_.first_to(i));
  }
  for (const PointIndex i : base_.changed()) {
    dissolve_at(i);
    dissolve(clusters_.of(base_.components()[i]));
  }
}

void FragmentLayer::take_over_components(const CloudChange& change) {
  shrunk_.clear();
  const auto move = [&](PointIndex point, ComponentId name) {
    const ComponentId before = components_[point];
    if (before != kNoComponent && (shrunk_.empty() || shrunk_.back() != before)) {
      shrunk_.push_back(before);
    }
    components_.set(point, name);
  };
  for (const PointIndex i : change.removed) {
    move(i, kNoComponent);
    labels_[i] = kNoComponent;
  }
  for (const PointIndex i : base_.changed()) move(i, base_.components()[i]);
}

/// Dissolves the clusters out of which a new edge leads before their exit.
void FragmentLayer::dissolve_reached_by(std::span<const PointIndex> added) {
  const EdgeWeight weight_of = config_.edge_weight();
  NeighbourCursor cursor(base_.neighbour_index());
  for (const PointIndex i : added) {
    cursor.for_each_neighbour(i, [&](PointIndex j) {
      const ClusterId cluster = clusters_.of(components_[j]);
      if (cluster == kNoCluster) return;
      const Edge edge{weight_of(cloud_[j], cloud_[i]), j, i};
      if (order_(edge, clusters_.exit(cluster))) dissolve(cluster);
    });
  }
}

/// Finds a cluster for each fragment that has none.
void FragmentLayer::find_clusters() {
  for (const PointIndex i : base_.changed()) find_cluster_of(i);
  for (const ComponentId name : shrunk_) {
    if (components_.num_points(name) > 0 && components_.is_fragment(name)) {
      find_cluster_of(base_.point_of(name));
    }
  }
  for (std::size_t k = 0; k < loose_.size(); ++k)
    find_cluster_of(loose_[k]);  // find_cluster_of() may append more
}

void FragmentLayer::find_cluster_of(PointIndex point) {
  if (!components_.is_in_fragment(point)) return;
  if (clusters_.of(components_[point]) != kNoCluster) return;
  const ClusterSearch::Found found = search_(point);
  for (const PointIndex i : found.points) dissolve(clusters_.of(components_[i]));
  queue(clusters_.add(found.points, found.exit));
}

/// Labels large components first, then clusters in the order of their exits: thus each comes after
/// the one that its exit leads to.
void FragmentLayer::label_points() {
  const auto label_if_large = [this](PointIndex point) {
    const ComponentId name = components_[point];
    if (name != kNoComponent && !components_.is_fragment(name)) relabel(point, name);
  };
  for (const PointIndex i : base_.changed()) label_if_large(i);
  for (const PointIndex i : loose_) label_if_large(i);
  while (!to_label_.empty()) {
    std::pop_heap(to_label_.begin(), to_label_.end(), LaterExit{*this});
    const ClusterId cluster = to_label_.back();
    to_label_.pop_back();
    const ComponentId label = label_of(cluster);
    clusters_.for_each_point(cluster, [&](PointIndex i) { relabel(i, label); });
  }
}

ComponentId FragmentLayer::label_of(ClusterId cluster) const {
  const Exit& exit = clusters_.exit(cluster);
  if (!exit.leads_out()) return components_[exit.i];
  const ClusterId other = clusters_.of(components_[exit.j]);
  const bool is_pair = other != kNoCluster && clusters_.exit(other).is_reverse_of(exit);
  return is_pair ? components_[order_.first_point(exit)] : labels_[exit.j];
}

/// Also queues the clusters whose exits lead to the point, since they get its label.
void FragmentLayer::relabel(PointIndex point, ComponentId label) {
  if (!set_label(point, label)) return;
  for (ClusterId c = clusters_.first_to(point); c != kNoCluster; c = clusters_.next_to(c)) {
    queue(c);
  }
}

void FragmentLayer::queue(ClusterId cluster) {
  to_label_.push_back(cluster);
  std::push_heap(to_label_.begin(), to_label_.end(), LaterExit{*this});
}

bool FragmentLayer::set_label(PointIndex point, ComponentId label) {
  if (labels_[point] == label) return false;
  labels_[point] = label;
  changed_.push_back(point);
  return true;
}

void FragmentLayer::swap_to(SwapSpace& space) {
  components_.swap_to(space);
  clusters_.swap_to(space);
  search_.swap_to(space);
  labels_.swap_to(space);
}

std::size_t FragmentLayer::bytes() const {
  return components_.bytes() + clusters_.bytes() + search_.bytes() + labels_.bytes() +
         (changed_.capacity() + loose_.capacity()) * sizeof(PointIndex);
}

}  // namespace kintsugi::segmenter

#include "segmenter/core/fragments/clusters.hpp"

#include <cassert>

namespace kintsugi::segmenter {

void Clusters::clear() {
  clusters_.clear();
  free_.clear();
  first_to_.clear();
  for (std::uint32_t& cluster : cluster_of_) cluster = 0;
}

ClusterId Clusters::add(std::span<const PointIndex> points, const Exit& exit) {
  if (free_.empty()) {
    free_.push_back(static_cast<ClusterId>(clusters_.size()));
    clusters_.emplace_back();
  }
  const ClusterId cluster = free_.back();
  free_.pop_back();
  clusters_[cluster] = {.exit = exit};
  for (std::size_t k = 0; k < points.size(); ++k) {
    next_[points[k]] = points[k + 1 < points.size() ? k + 1 : 0];
    const ComponentId name = components_[points[k]];
    if (name >= cluster_of_.size()) cluster_of_.resize(name + std::size_t{1});
    cluster_of_[name] = cluster + 1;
  }
  if (exit.leads_out()) link(cluster);
  return cluster;
}

void Clusters::dissolve(ClusterId cluster, std::vector<PointIndex>& points) {
  for_each_point(cluster, [&](PointIndex point) {
    points.push_back(point);
    assert(components_[point] != kNoComponent);
    cluster_of_[components_[point]] = 0;
  });
  if (clusters_[cluster].exit.leads_out()) unlink(cluster);
  free_.push_back(cluster);
}

void Clusters::link(ClusterId cluster) {
  const auto [place, is_first] = first_to_.try_emplace(clusters_[cluster].exit.j, cluster);
  if (is_first) return;
  clusters_[cluster].next = place->second;
  clusters_[place->second].previous = cluster;
  place->second = cluster;
}

void Clusters::unlink(ClusterId cluster) {
  const auto [exit, next, previous] = clusters_[cluster];
  if (next != kNoCluster) clusters_[next].previous = previous;
  if (previous != kNoCluster) {
    clusters_[previous].next = next;
  } else if (next != kNoCluster) {
    first_to_[exit.j] = next;
  } else {
    first_to_.erase(exit.j);
  }
}

std::size_t Clusters::bytes() const {
  constexpr std::size_t kMapNodeBytes = 32;
  return clusters_.capacity() * sizeof(Cluster) + free_.capacity() * sizeof(ClusterId) +
         cluster_of_.bytes() + next_.bytes() + first_to_.size() * kMapNodeBytes;
}

}  // namespace kintsugi::segmenter

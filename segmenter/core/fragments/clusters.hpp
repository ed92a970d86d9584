#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include "lcmtypes/base/growing_array.hpp"
#include "segmenter/core/fragments/base_components.hpp"
#include "segmenter/core/graph/edge.hpp"

namespace kintsugi::segmenter {

using ClusterId = std::uint32_t;
inline constexpr ClusterId kNoCluster = UINT32_MAX;

/// The edge by which a cluster reaches the limit: from its point `i` to point `j` of another
/// component. A cluster that never reaches it has an exit to kNowhere that is heavier than any
/// edge, and `i` is in the component that gives the cluster its name.
struct Exit : Edge {
  static constexpr PointIndex kNowhere = UINT32_MAX;

  static Exit along(const Edge& edge) { return Exit{edge}; }
  static Exit none(PointIndex namer) {
    return Exit{{std::numeric_limits<float>::infinity(), namer, kNowhere}};
  }
  bool leads_out() const { return j != kNowhere; }
  bool is_reverse_of(const Exit& other) const { return i == other.j && j == other.i; }
};

/// The clusters of the fragment layer: their fragments and their exits.
class Clusters {
 public:
  explicit Clusters(const BaseComponents& components) : components_(components) {}

  void grow(PointIndex num_points) { next_.resize(num_points); }
  /// Removes all clusters.
  void clear();

  /// The cluster of a fragment; kNoCluster where there is none.
  ClusterId of(ComponentId name) const {
    return name < cluster_of_.size() ? cluster_of_[name] - 1 : kNoCluster;
  }
  const Exit& exit(ClusterId cluster) const { return clusters_[cluster].exit; }

  /// Adds a cluster of the fragments that have `points`. They must be in no cluster.
  ClusterId add(std::span<const PointIndex> points, const Exit& exit);
  /// Removes a cluster and appends its points to `points`. The names of its fragments must be the
  /// same as when it was added.
  void dissolve(ClusterId cluster, std::vector<PointIndex>& points);

  /// Calls fn(PointIndex) for each point of a cluster.
  template <typename Fn>
  void for_each_point(ClusterId cluster, Fn&& fn) const {
    const PointIndex head = clusters_[cluster].exit.i;
    PointIndex point = head;
    do {
      fn(point);
      point = next_[point];
    } while (point != head);
  }
  /// The clusters whose exits lead to `point`, as a list: the first one, and the one after
  /// `cluster`; kNoCluster at the end.
  ClusterId first_to(PointIndex point) const {
    const auto found = first_to_.find(point);
    return found == first_to_.end() ? kNoCluster : found->second;
  }
  ClusterId next_to(ClusterId cluster) const { return clusters_[cluster].next; }

  void swap_to(SwapSpace& space) {
    cluster_of_.swap_to(space);
    next_.swap_to(space);
  }
  std::size_t bytes() const;

 private:
  struct Cluster {
    Exit exit;
    // In the list of clusters whose exits lead to the same point.
    ClusterId next = kNoCluster;
    ClusterId previous = kNoCluster;
  };

  void link(ClusterId cluster);
  void unlink(ClusterId cluster);

  const BaseComponents& components_;
  std::vector<Cluster> clusters_;
  std::vector<ClusterId> free_;
  GrowingArray<std::uint32_t> cluster_of_;  ///< by name of a fragment: cluster + 1, or 0
  GrowingArray<PointIndex> next_;           ///< by point: the next one of its cluster, in a circle
  std::unordered_map<PointIndex, ClusterId> first_to_;
};

}  // namespace kintsugi::segmenter

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "segmenter/core/engine/incremental_engine.hpp"
#include "segmenter/core/fragments/base_components.hpp"
#include "segmenter/core/fragments/cluster_search.hpp"
#include "segmenter/core/fragments/clusters.hpp"
#include "segmenter/core/fragments/edge_order.hpp"
#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter {

/// Keeps the result of join_fragments() up to date as the partition of an engine changes, at a cost
/// that depends on the change.
///
/// Terms. A fragment is a component of fewer than m points, where m is the limit
/// (EngineConfig::fragment_limit()); all others are large. Take the edges in order (EdgeOrder). The
/// cluster of a fragment is the set that it has been joined to just before that set reaches m
/// points. Its exit is the edge (x, y), x inside, by which it reaches m. For each cluster the layer
/// stores its points and its exit.
///
/// Why it is exact, in short:
/// 1. A set of fewer than m points joins along every edge that leads out of it. So at each time
/// such a
///    set is a connected component of the graph of the edges so far. Therefore the clusters
///    partition the fragments, and each can be found by itself: Prim's algorithm takes all edges
///    before the exit first, and ends with at most m points or at a component that is large by
///    itself.
/// 2. When the exit is taken, y is in a set of m points or more, or the cluster of y has the same
///    edge as its exit. In the first case y is in a large component, or in a cluster with an
///    earlier exit; sets of m points or more never join each other; so the cluster gets the label
///    of y. In the second case both clusters form a new segment. Following exits therefore ends,
///    and gives the partition.
/// 3. A cluster stays valid if (a) its fragments have the same points, (b) y exists, (c) no new
/// edge
///    leads out of it before its exit, and (d) together with the side of y it still reaches m.
///    update() dissolves the clusters for which (a), (b) or (c) fails. If only (d) fails, the
///    component of y has changed or the cluster of y was dissolved. The new cluster of y then ends
///    after the exit and contains x, and a new cluster dissolves every old one that it meets.
///    (Suppose an invalid old cluster were never met. Take the one with the earliest exit: the
///    cluster of y has an earlier one, so it is valid, and (d) holds; a contradiction.)
class FragmentLayer {
 public:
  /// `base`, the engine below, and `cloud` must outlive the layer.
  FragmentLayer(const PointCloud& cloud, const IncrementalEngine& base, const EngineConfig& config);

  /// To be called after base.update(change). `rows`: the points of the cloud; null where nobody has
  /// them.
  void update(const CloudChange& change, const PointRows* rows);

  /// As in SegmentationEngine. Each component has the name of one of the base engine's.
  std::span<const ComponentId> components() const { return labels_.span(); }
  std::span<const PointIndex> changed() const { return changed_; }

  void swap_to(SwapSpace& space);
  std::size_t bytes() const;

 private:
  void grow();
  bool is_cheaper_to_rebuild(const CloudChange& change) const;
  void rebuild(const CloudChange& change, const PointRows* rows);

  void dissolve(ClusterId cluster);
  void dissolve_changed(const CloudChange& change);
  void take_over_components(const CloudChange& change);
  void dissolve_reached_by(std::span<const PointIndex> added);
  void find_clusters();
  void find_cluster_of(PointIndex point);

  /// Orders clusters by their exits; those without one come last.
  struct LaterExit {
    const FragmentLayer& layer;
    bool operator()(ClusterId a, ClusterId b) const {
      const Exit& exit_a = layer.clusters_.exit(a);
      const Exit& exit_b = layer.clusters_.exit(b);
      return exit_a.leads_out() ? exit_b.leads_out() && layer.order_(exit_b, exit_a)
                                : exit_b.leads_out();
    }
  };

  void label_points();
  ComponentId label_of(ClusterId cluster) const;
  void relabel(PointIndex point, ComponentId label);
  void queue(ClusterId cluster);
  bool set_label(PointIndex point, ComponentId label);

  const PointCloud& cloud_;
  const IncrementalEngine& base_;
  EngineConfig config_;
  EdgeOrder order_;
  BaseComponents components_;
  Clusters clusters_;
  ClusterSearch search_;
  GrowingArray<ComponentId> labels_;
  std::vector<PointIndex> changed_;

  // Used within one update.
  std::vector<PointIndex> loose_;    ///< points of dissolved clusters
  std::vector<ComponentId> shrunk_;  ///< components that lost points
  std::vector<ClusterId> to_label_;  ///< heap, the earliest exit on top
};

}  // namespace kintsugi::segmenter

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

namespace kintsugi::segmenter {

/// What join_fragments() makes of the partition of an engine, kept up to date: after each update
/// the same, at a cost that depends on the change.
///
/// How it works. Take the edges in order (EdgeOrder), and call a fragment's cluster what it has
/// been joined to just before that came to the limit. Remembered is, for each cluster, its points
/// and its exit: the edge (x, y) by which it came to the limit, x inside.
///
/// Why it is exact, in short (at an edge: when its turn comes; m: the limit):
/// 1. No edge of a set of fewer than m points has been passed over, so such a set is a connected
///    component of the graph of the edges so far. Therefore the clusters are a partition of the
///    fragments, and each can be found alone: Prim's algorithm takes all edges below the exit
///    before the exit, and ends with at most m points or at a component that is large by itself.
/// 2. At its exit, y is in a component of m points or more, or its cluster ends with the same edge.
///    In the first case y is in a large component, or in a cluster whose exit comes before; large
///    ones never join each other; so the cluster goes where y is. In the second the two are a new
///    segment. Following exits therefore ends, and gives the partition.
/// 3. A cluster stays as it is when (a) its fragments have the points they had, (b) y is there,
///    (c) no new edge leads out of it before its exit, and (d) with y's side it still comes to m.
///    update() dissolves those where (a), (b) or (c) fails. Where only (d) does, y's component has
///    changed or y's cluster was dissolved, so y's new cluster ends after the exit and contains x:
///    a new cluster dissolves every old one that it meets. (Were an old one wrong and not met, take
///    the one that ends first: y's cluster ends before it, so it is right, and (d) holds.)
class FragmentLayer {
 public:
  /// On top of `base`, which must outlive it, as `cloud`.
  FragmentLayer(const PointCloud& cloud, const IncrementalEngine& base, const EngineConfig& config);

  /// Takes over an update of the base engine with `change`.
  void update(const CloudChange& change);

  /// As those of SegmentationEngine. Each component is called after one of the base engine's.
  std::span<const ComponentId> components() const { return labels_.span(); }
  std::span<const PointIndex> changed() const { return changed_; }

  std::size_t bytes() const;

 private:
  void grow();
  bool is_cheaper_to_rebuild(const CloudChange& change) const;
  void rebuild(const CloudChange& change);

  void dissolve(ClusterId cluster);
  void dissolve_changed(const CloudChange& change);
  void take_over_components(const CloudChange& change);
  void dissolve_reached_by(std::span<const PointIndex> added);
  void find_clusters();
  void find_cluster_of(PointIndex point);

  /// Of two clusters: by their exits, those without last.
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

  // One update.
  std::vector<PointIndex> loose_;    ///< points of clusters that were dissolved
  std::vector<ComponentId> shrunk_;  ///< components that lost points
  std::vector<ClusterId> to_label_;  ///< heap, the first exit on top
};

}  // namespace kintsugi::segmenter

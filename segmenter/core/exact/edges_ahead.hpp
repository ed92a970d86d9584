#pragma once

#include <future>
#include <optional>
#include <span>
#include <vector>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/exact/edge_key.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter::exact {

/// Finds the edges of points that are to be added later, on a thread of its own.
class EdgesAhead {
 public:
  /// `cloud` and `index` must not change between start() and finish(). Edges of max_weight()
  /// and more are left out.
  EdgesAhead(const PointCloud& cloud, const NeighbourIndex& index, const EngineConfig& config)
      : cloud_(cloud), index_(index), config_(config) {}
  ~EdgesAhead() {
    if (search_.valid()) search_.wait();  // what it throws is nobody's any more
  }

  /// Begins to look for the edges among the points of a slice, and between them and the points in
  /// the index.
  void start(std::span<const CloudPoint> slice_W);
  /// Waits for what start() began; throws what it threw.
  void finish();

  /// The edges, if `added`, points of the cloud, are those of start(); nothing otherwise. Nothing
  /// may have come into the index, or left it, since start().
  std::optional<std::vector<EdgeKey>> take(std::span<const PointIndex> added);

 private:
  /// An edge of point `i` of the slice.
  struct AheadEdge {
    float weight;
    PointIndex i;
    PointIndex other;  ///< of the slice, or of the cloud
  };
  struct Found {
    PointCloud slice;  ///< its points that can be segmented, by their places in it
    std::vector<AheadEdge> inner;
    std::vector<AheadEdge> outer;
  };

  Found find(std::vector<CloudPoint> slice_W) const;

  const PointCloud& cloud_;
  const NeighbourIndex& index_;
  EngineConfig config_;
  std::future<Found> search_;
  std::optional<Found> found_;
};

}  // namespace kintsugi::segmenter::exact

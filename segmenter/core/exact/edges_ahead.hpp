#pragma once

#include <future>
#include <optional>
#include <span>
#include <vector>

#include "segmenter/core/exact/edge_key.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter::exact {

/// Finds the edges of points that will be added later, in a thread of its own.
class EdgesAhead {
 public:
  /// `cloud` and `index` must not change between start() and finish(). Only edges below
  /// max_weight() are found.
  EdgesAhead(const PointCloud& cloud, const NeighbourIndex& index, const EngineConfig& config)
      : cloud_(cloud), index_(index), config_(config) {}
  ~EdgesAhead() {
    if (search_.valid()) search_.wait();  // without get(): a destructor must not throw its error
  }

  /// Starts the search for the edges among the points of a slice, and between these and the points
  /// in the index.
  void start(std::span<const CloudPoint> slice_W);
  /// Waits for the end of the search.
  /// @throws what the search threw
  void finish();

  /// The edges that were found, if the points `added` of the cloud are those of start(); nothing
  /// otherwise. The index must be as it was at start().
  std::optional<std::vector<EdgeKey>> take(std::span<const PointIndex> added);

 private:
  /// An edge of point `i` of the slice.
  struct AheadEdge {
    float weight;
    PointIndex i;
    PointIndex other;  ///< point of the slice (inner) or of the cloud (outer)
  };
  struct Found {
    PointCloud slice;              ///< without its inadmissible points
    std::vector<AheadEdge> inner;  ///< between two points of the slice
    std::vector<AheadEdge> outer;  ///< between the slice and the cloud
  };

  Found find(std::vector<CloudPoint> slice_W) const;

  const PointCloud& cloud_;
  const NeighbourIndex& index_;
  EngineConfig config_;
  std::future<Found> search_;
  std::optional<Found> found_;
};

}  // namespace kintsugi::segmenter::exact

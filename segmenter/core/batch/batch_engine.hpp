#pragma once

#include <memory>
#include <vector>

#include "segmenter/core/batch/batch_segmentation.hpp"
#include "segmenter/core/batch/segment_forest.hpp"
#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter {

/// Mode `batch`, the reference: each update runs Algorithm 1, and the fragment step if the config
/// has one, over all points.
class BatchEngine final : public SegmentationEngine {
 public:
  BatchEngine(const PointCloud& cloud, const EngineConfig& config);

  RunStatistics update(const CloudChange& change) override;
  bool takes_moves_in_place() const override { return true; }
  std::span<const ComponentId> components() const override {
    return joins_fragments() ? joined_ : components_;
  }
  std::span<const ComponentId> unmerged_components() const override { return components_; }
  std::span<const PointIndex> changed() const override { return changed_; }
  double theta(ComponentId component) const override;
  std::size_t bytes() const override;

 private:
  std::vector<ComponentId> take_over(const CloudChange& change);
  BatchStatistics segment(std::span<const PointIndex> points);
  bool joins_fragments() const { return config_.fragment_limit() > 0; }
  void join_fragments_of(std::span<const PointIndex> points);

  const PointCloud& cloud_;
  EngineConfig config_;
  std::unique_ptr<NeighbourIndex> index_;  ///< null for kGrid, which segment_points() does without
  SegmentForest forest_;
  std::vector<ComponentId> components_;  ///< each named by its smallest point
  std::vector<ComponentId> joined_;      ///< with fragments joined; empty without a fragment step
  std::vector<PointIndex> changed_;
};

}  // namespace kintsugi::segmenter

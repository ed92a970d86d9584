#pragma once

#include <vector>

#include "segmenter/core/engine.hpp"

namespace kintsugi::segmenter::fuzz {

/// Batch over the points in the map, from scratch at each update, in a cloud of their own: what an
/// engine has to be, to try the harness on.
class RebuildingEngine final : public SegmentationEngine {
 public:
  RebuildingEngine(const PointCloud& cloud, const EngineConfig& config)
      : cloud_(cloud), config_(config) {}

  RunStatistics update(const CloudChange& change) override;
  std::span<const ComponentId> components() const override { return components_; }
  std::span<const PointIndex> changed() const override { return changed_; }
  double theta(ComponentId component) const override { return thetas_[component]; }

 private:
  const PointCloud& cloud_;
  EngineConfig config_;
  std::vector<bool> is_in_;
  std::vector<ComponentId> components_;  ///< named by the smallest point
  std::vector<double> thetas_;           ///< by component
  std::vector<PointIndex> changed_;
};

}  // namespace kintsugi::segmenter::fuzz

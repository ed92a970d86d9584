#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>

#include "segmenter/core/batch/batch_engine.hpp"
#include "segmenter/core/engine/engine.hpp"

namespace kintsugi::segmenter {

/// An engine gave another result than batch.
class AuditError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Compares an engine with batch: after each update every label and every theta must be the same,
/// to the bit, before and after fragments are joined. Each update costs a run of batch.
class AuditedEngine final : public SegmentationEngine {
 public:
  AuditedEngine(std::unique_ptr<SegmentationEngine> engine, const PointCloud& cloud,
                const EngineConfig& config);

  /// @throws AuditError naming the first point that differs
  RunStatistics update(const CloudChange& change) override;
  bool takes_moves_in_place() const override { return engine_->takes_moves_in_place(); }
  void look_ahead(std::span<const CloudPoint> slice_W) override { engine_->look_ahead(slice_W); }
  std::span<const ComponentId> components() const override { return engine_->components(); }
  std::span<const ComponentId> unmerged_components() const override {
    return engine_->unmerged_components();
  }
  std::span<const PointIndex> changed() const override { return engine_->changed(); }
  double theta(ComponentId component) const override { return engine_->theta(component); }
  void swap_to(SwapSpace& space) override { engine_->swap_to(space); }
  std::size_t bytes() const override { return engine_->bytes() + reference_.bytes(); }

 private:
  void compare(std::span<const ComponentId> components,
               std::span<const ComponentId> expected) const;

  std::unique_ptr<SegmentationEngine> engine_;
  const PointCloud& cloud_;
  BatchEngine reference_;
  std::int64_t num_updates_ = 0;
};

}  // namespace kintsugi::segmenter

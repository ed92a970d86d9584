#pragma once

#include <memory>

#include "segmenter/core/engine/incremental_engine.hpp"
#include "segmenter/core/fragments/fragment_layer.hpp"

namespace kintsugi::segmenter {

/// An engine whose fragments are joined to their neighbours: FragmentLayer on top of it.
class FragmentEngine final : public SegmentationEngine {
 public:
  /// `engine` is of the same cloud and config, which has a fragment_limit() > 0.
  FragmentEngine(std::unique_ptr<IncrementalEngine> engine, const PointCloud& cloud,
                 const EngineConfig& config)
      : engine_(std::move(engine)), layer_(cloud, *engine_, config) {}

  RunStatistics update(const CloudChange& change) override;
  /// `components` are the unmerged ones.
  void resume(const CloudChange& everything, std::span<const ComponentId> components,
              std::span<const double> thetas) override;
  void look_ahead(std::span<const CloudPoint> slice_W) override { engine_->look_ahead(slice_W); }
  std::span<const ComponentId> components() const override { return layer_.components(); }
  std::span<const ComponentId> unmerged_components() const override {
    return engine_->components();
  }
  std::span<const PointIndex> changed() const override { return layer_.changed(); }
  double theta(ComponentId component) const override { return engine_->theta(component); }
  std::size_t bytes() const override { return engine_->bytes() + layer_.bytes(); }

 private:
  std::unique_ptr<IncrementalEngine> engine_;
  FragmentLayer layer_;
};

}  // namespace kintsugi::segmenter

#pragma once

#include <memory>

#include "segmenter/core/engine/incremental_engine.hpp"
#include "segmenter/core/fragments/fragment_layer.hpp"

namespace kintsugi::segmenter {

/// An engine with a FragmentLayer on top of it, which joins fragments to their neighbours.
class FragmentEngine final : public SegmentationEngine {
 public:
  /// `engine` must have the same cloud and config; config.fragment_limit() > 0.
  FragmentEngine(std::unique_ptr<IncrementalEngine> engine, const PointCloud& cloud,
                 const EngineConfig& config)
      : engine_(std::move(engine)), layer_(cloud, *engine_, config) {}

  RunStatistics update(const CloudChange& change) override;
  bool takes_moves_in_place() const override { return engine_->takes_moves_in_place(); }
  /// `components` are those before fragments are joined.
  void resume(const CloudChange& everything, std::span<const ComponentId> components,
              std::span<const double> thetas) override;
  void look_ahead(std::span<const CloudPoint> slice_W) override { engine_->look_ahead(slice_W); }
  std::span<const ComponentId> components() const override { return layer_.components(); }
  std::span<const ComponentId> unmerged_components() const override {
    return engine_->components();
  }
  std::span<const PointIndex> changed() const override { return layer_.changed(); }
  double theta(ComponentId component) const override { return engine_->theta(component); }
  void swap_to(SwapSpace& space) override {
    engine_->swap_to(space);
    layer_.swap_to(space);
  }
  std::size_t bytes() const override { return engine_->bytes() + layer_.bytes(); }

 private:
  std::unique_ptr<IncrementalEngine> engine_;
  FragmentLayer layer_;
};

}  // namespace kintsugi::segmenter

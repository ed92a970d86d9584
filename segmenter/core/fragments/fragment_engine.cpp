#include "segmenter/core/fragments/fragment_engine.hpp"

#include "lcmtypes/base/stopwatch.hpp"

namespace kintsugi::segmenter {

RunStatistics FragmentEngine::update(const CloudChange& change) {
  RunStatistics statistics = engine_->update(change);
  const Stopwatch stopwatch;
  layer_.update(change, engine_->take_rows().get());
  statistics.fragments_ms = stopwatch.elapsed_ms();
  return statistics;
}

void FragmentEngine::resume(const CloudChange& everything, std::span<const ComponentId> components,
                            std::span<const double> thetas) {
  engine_->resume(everything, components, thetas);
  layer_.update(everything, engine_->take_rows().get());
}

}  // namespace kintsugi::segmenter

#include "segmenter/core/fragments/fragment_engine.hpp"

#include <chrono>

namespace kintsugi::segmenter {

RunStatistics FragmentEngine::update(const CloudChange& change) {
  RunStatistics statistics = engine_->update(change);
  const auto start = std::chrono::steady_clock::now();
  layer_.update(change);
  const auto taken = std::chrono::steady_clock::now() - start;
  statistics.fragments_ms = std::chrono::duration<double, std::milli>(taken).count();
  return statistics;
}

void FragmentEngine::resume(const CloudChange& everything, std::span<const ComponentId> components,
                            std::span<const double> thetas) {
  engine_->resume(everything, components, thetas);
  layer_.update(everything);
}

}  // namespace kintsugi::segmenter

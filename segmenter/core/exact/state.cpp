#include "segmenter/core/exact/state.hpp"

#include <oneapi/tbb/parallel_for.h>

namespace kintsugi::segmenter::exact {

void State::clear() {
  oneapi::tbb::parallel_for(std::size_t{0}, vertices.size(), [this](std::size_t i) {
    const auto x = static_cast<PointIndex>(i);
    const bool is_gone = vertices[x].is_gone;
    vertices.reset(x);
    vertices[x].is_gone = is_gone;
  });
  edges.clear();
  watches.clear();
}

}  // namespace kintsugi::segmenter::exact

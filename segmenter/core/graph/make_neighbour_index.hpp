#pragma once

#include <memory>

#include "segmenter/core/graph/neighbour_index.hpp"

namespace kintsugi::segmenter {

/// An empty index of this kind. `cloud` must outlive it; `radius_m` > 0.
std::unique_ptr<NeighbourIndex> make_neighbour_index(NeighbourSearch kind, const PointCloud& cloud,
                                                     float radius_m);

}  // namespace kintsugi::segmenter

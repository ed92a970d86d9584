#include "segmenter/core/graph/make_neighbour_index.hpp"

#include "segmenter/core/graph/flann_index.hpp"
#include "segmenter/core/graph/grid_index.hpp"

namespace kintsugi::segmenter {

std::unique_ptr<NeighbourIndex> make_neighbour_index(NeighbourSearch kind, const PointCloud& cloud,
                                                     float radius_m) {
  if (kind == NeighbourSearch::kFlann) return std::make_unique<FlannIndex>(cloud, radius_m);
  return std::make_unique<GridIndex>(cloud, radius_m);
}

}  // namespace kintsugi::segmenter

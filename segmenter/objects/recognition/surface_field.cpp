#include "segmenter/objects/recognition/surface_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "segmenter/objects/recognition/grid_cells.hpp"

namespace kintsugi::segmenter {

SurfaceField::SurfaceField(const Surface& surface, float cell_m, float reach_m) {
  if (surface.empty()) return;
  Eigen::Vector3f low = surface.front().position;
  Eigen::Vector3f high = low;
  for (const SurfacePoint& point : surface) {
    low = low.cwiseMin(point.position);
    high = high.cwiseMax(point.position);
  }
  origin_ = low.array() - reach_m;
  const Eigen::Vector3f extent = (high - low).array() + 2 * reach_m;
  inverse_cell_ = 1.0F / bounded_cell_m(cell_m, extent, kMaxCells);
  size_ = (extent * inverse_cell_).array().ceil().max(1.0F).matrix().cast<int>();
  const std::size_t num_cells =
      static_cast<std::size_t>(size_.x()) * size_.y() * static_cast<std::size_t>(size_.z());
  nearest_.assign(num_cells, -1);
  std::vector<float> squared_distance(num_cells, std::numeric_limits<float>::infinity());
  const int around = static_cast<int>(std::ceil(reach_m * inverse_cell_));
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const Eigen::Vector3f at = (surface[i].position - origin_) * inverse_cell_;
    const Eigen::Vector3i middle = at.cast<int>();
    const Eigen::Vector3i first = (middle.array() - around).max(0);
    const Eigen::Vector3i last = (middle.array() + around).min(size_.array() - 1);
    for (int z = first.z(); z <= last.z(); ++z) {
      for (int y = first.y(); y <= last.y(); ++y) {
        for (int x = first.x(); x <= last.x(); ++x) {
          const Eigen::Vector3f centre = Eigen::Vector3i(x, y, z).cast<float>().array() + 0.5F;
          const float squared = (centre - at).squaredNorm();
          const std::size_t cell = index({x, y, z});
          if (squared >= squared_distance[cell]) continue;
          squared_distance[cell] = squared;
          nearest_[cell] = static_cast<std::int32_t>(i);
        }
      }
    }
  }
}

}  // namespace kintsugi::segmenter

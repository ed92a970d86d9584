#include "segmenter/objects/changes/surface_behind.hpp"

#include <cstddef>

#include "segmenter/objects/maps/surface_samples.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr double kBeyond_vox = 0.5;  // of what is the same surface
// What is farther behind a place is told from it by each view: its noise at 3 m, three times.
constexpr double kFarthest_m = 0.05;

}  // namespace

std::vector<bool> have_surface_behind(std::span<const CloudPoint> points, const MapSide& map,
                                      double same_m) {
  std::vector<bool> have(points.size(), false);
  const auto reach_m = static_cast<float>(map.voxel_m());
  for (double depth_m = same_m + kBeyond_vox * map.voxel_m(); depth_m <= kFarthest_m;
       depth_m += map.voxel_m()) {
    std::vector<CloudPoint> behind(points.begin(), points.end());
    for (CloudPoint& p : behind) {
      p.x -= static_cast<float>(depth_m) * p.nx;
      p.y -= static_cast<float>(depth_m) * p.ny;
      p.z -= static_cast<float>(depth_m) * p.nz;
    }
    NearestNeighbours::Result nearest;
    map.tree().find(behind, 1, nearest);
    for (std::size_t i = 0; i < behind.size() && nearest.count > 0; ++i) {
      const CloudPoint& there = map.points()[nearest.indices[i]];
      const bool is_there = nearest.squared_distances[i] <= reach_m * reach_m &&
                            normal_of(there).dot(normal_of(behind[i])) >= kAlikeNormals;
      if (is_there) have[i] = true;
    }
  }
  return have;
}

}  // namespace kintsugi::segmenter

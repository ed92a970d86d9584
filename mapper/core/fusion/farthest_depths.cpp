#include "mapper/core/fusion/farthest_depths.hpp"

#include <algorithm>
#include <cstddef>

#include "mapper/core/fusion/image_tiles.hpp"

namespace kintsugi::mapper {

FarthestDepths::FarthestDepths(const cv::Mat_<float>& depth_m, const PinholeCamera& camera,
                               float max_depth_m)
    : camera_(camera),
      num_columns_(num_tiles_along(camera.width, kSide_px)),
      num_rows_(num_tiles_along(camera.height, kSide_px)) {
  std::vector<float> farthest_m(static_cast<std::size_t>(num_columns_) * kSide_px);  // by column
  for (int first_v = 0; first_v < camera.height; first_v += kSide_px) {
    std::fill(farthest_m.begin(), farthest_m.end(), 0.0F);
    for (int v = first_v; v < std::min(first_v + kSide_px, camera.height); ++v) {
      const float* row = depth_m[v];
      for (int u = 0; u < camera.width;
           ++u) {  // no branches, so that the compiler can vectorise it
        const float counted_m = row[u] <= max_depth_m ? row[u] : 0.0F;
        farthest_m[u] = counted_m > farthest_m[u] ? counted_m : farthest_m[u];
      }
    }
    for (auto tile = farthest_m.begin(); tile != farthest_m.end(); tile += kSide_px) {
      farthest_m_.push_back(*std::max_element(tile, tile + kSide_px));
    }
  }
}

float FarthestDepths::within(const Eigen::Vector3f& center_C, float radius_m) const {
  const TileSpan columns = tiles_of_sphere(center_C.x(), center_C.z(), radius_m, camera_.fx,
                                           camera_.cx, num_columns_, kSide_px);
  const TileSpan rows = tiles_of_sphere(center_C.y(), center_C.z(), radius_m, camera_.fy,
                                        camera_.cy, num_rows_, kSide_px);
  float farthest_m = 0.0F;
  for (int row = rows.first; row <= rows.last; ++row) {
    const float* tiles = &farthest_m_[static_cast<std::size_t>(row) * num_columns_];
    farthest_m =
        std::max(farthest_m, *std::max_element(tiles + columns.first, tiles + columns.last + 1));
  }
  return farthest_m;
}

}  // namespace kintsugi::mapper

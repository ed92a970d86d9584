#include "segmenter/objects/recognition/scene_surface.hpp"

#include <algorithm>
#include <cstddef>

namespace kintsugi::segmenter {

namespace {

// Model points look this far for what is seen in their place.
constexpr float kReach = 2.0F;  // voxels

}  // namespace

SceneSurface::SceneSurface(std::span<const CloudPoint> points_W,
                           std::span<const std::uint32_t> segment_ids, float resolution_m)
    : surface_W_(unthinned(points_W)),
      segment_ids_(segment_ids.begin(), segment_ids.end()),
      resolution_m_(resolution_m),
      field_(surface_W_, resolution_m, kReach * resolution_m) {}

Surface SceneSurface::of_segments(std::span<const std::uint32_t> ids) const {
  Surface surface;
  for (std::size_t i = 0; i < surface_W_.size(); ++i) {
    if (std::binary_search(ids.begin(), ids.end(), segment_ids_[i])) {
      surface.push_back(surface_W_[i]);
    }
  }
  return surface;
}

}  // namespace kintsugi::segmenter

#include "viewer/core/view/view_segments.hpp"

#include "viewer/core/view/camera_image.hpp"

namespace kintsugi::viewer {

IdImage segments_in_view(std::span<const PointChunk> chunks, const CameraView& view, cv::Size size,
                         const SplatConfig& config) {
  IdImage ids(size, static_cast<std::int32_t>(kNoSegment));
  if (!is_located(view.state)) return ids;
  const MeasuredDepth measured = measured_depth(view, size);
  const VisibilityImage visible = splat_points(chunks, camera_of(view, size), config, &measured);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      if (visible.empty(u, v)) continue;
      const PointChunk& chunk = chunks[visible.chunk(u, v)];
      ids(v, u) = static_cast<std::int32_t>(chunk.labels[visible.point(u, v)]);
    }
  }
  return ids;
}

}  // namespace kintsugi::viewer

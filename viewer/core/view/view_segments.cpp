#include "viewer/core/view/view_segments.hpp"

#include "viewer/core/camera/virtual_camera.hpp"
#include "viewer/core/view/camera_image.hpp"

namespace kintsugi::viewer {
namespace {

/// The depth camera, with pictures of this size.
VirtualCamera camera_of(const CameraView& view, cv::Size size) {
  VirtualCamera camera{view.intrinsics, view.X_WC};
  Intrinsics& k = camera.intrinsics;
  const double along_u = static_cast<double>(size.width) / k.width;
  const double along_v = static_cast<double>(size.height) / k.height;
  k.fx *= along_u;
  k.fy *= along_v;
  k.cx = along_u * (k.cx + 0.5) - 0.5;
  k.cy = along_v * (k.cy + 0.5) - 0.5;
  k.width = size.width;
  k.height = size.height;
  return camera;
}

}  // namespace

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

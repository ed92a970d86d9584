#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "viewer/core/rendering/highlight.hpp"
#include "viewer/core/rendering/splat.hpp"

namespace kintsugi::viewer {

/// What decides the colour of a point.
enum class Coloring {
  kTrue,      ///< the depth camera's colour image
  kSegments,  ///< its label: segment_color()
};

/// Draws the picture of what splat_points() found for these chunks and this camera. Surfaces are
/// lit from the camera, and edges in depth are darkened (eye-dome lighting, Boucheny 2009), so that
/// shape is visible within one colour. Points that are not highlighted are dimmed, unless
/// `highlight` is empty. Pixels without a point are palette::kBackground.
cv::Mat3b shade(const VisibilityImage& visible, std::span<const PointChunk> chunks,
                const VirtualCamera& camera, Coloring coloring, const Highlight& highlight = {});

}  // namespace kintsugi::viewer

#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "viewer/core/rendering/highlight.hpp"
#include "viewer/core/rendering/splat.hpp"

namespace kintsugi::viewer {

enum class Coloring {
  kTrue,      ///< the colour that the camera saw
  kSegments,  ///< segment_color() of the label
};

/// Colours what splat_points() found, as seen by `camera`; `chunks` are those it was given.
/// Surfaces get light from the camera's side, and edges in depth are darkened (eye-dome lighting,
/// Boucheny 2009), so that shape shows within one colour. What is not highlighted
/// is dimmed, unless nothing is. Pixels with nothing are palette::kBackground.
cv::Mat3b shade(const VisibilityImage& visible, std::span<const PointChunk> chunks,
                const VirtualCamera& camera, Coloring coloring, const Highlight& highlight = {});

}  // namespace kintsugi::viewer

#pragma once

#include <span>

#include "lcmtypes/messages.hpp"
#include "viewer/core/map/point_chunk.hpp"
#include "viewer/core/rendering/id_image.hpp"
#include "viewer/core/rendering/splat.hpp"

namespace kintsugi::viewer {

/// The segment of the map that the depth camera sees in each pixel of a picture of this size, taken
/// from its place. kNoSegment: the surface in view has no segment yet, nothing is measured there,
/// or the camera does not know where it is.
///
/// A point of the map counts only where it agrees with the depth that is measured: nothing behind
/// the surface in view shines through, and nothing that is no longer there covers it.
IdImage segments_in_view(std::span<const PointChunk> chunks, const CameraView& view, cv::Size size,
                         const SplatConfig& config);

}  // namespace kintsugi::viewer

#pragma once
// What a camera measures at a pixel.

#include <optional>

#include "lcmtypes/messages.hpp"
#include "segmenter/query/place_search.hpp"

namespace kintsugi::segmenter {

/// What the camera measures at the pixel (u, v) of its depth image, which need not be integers: the
/// point of the depth sample nearest to the pixel, which is at most about half a
/// CameraView::depth_step away. Nothing where that sample has no depth. Its neighbours do not stand
/// in: depth is missing where a thing is dark, shiny or thin, and what is beside it may be the
/// surface behind.
/// @throws std::invalid_argument when the pixel is outside the image
std::optional<MeasuredPoint> measured_point(const CameraView& view, double u_px, double v_px);

/// The same for the sample (i, j), which is in the image.
std::optional<MeasuredPoint> measured_sample(const CameraView& view, int i, int j);

/// How far a map point may be from what the camera measures: at least two voxels, as for other
/// places, and at least 3 cm. The map is an average of many frames, while a single measurement has
/// the noise of the camera: 3 cm is twice its standard deviation for structured light at about
/// 3 m (1.9 mm m^-2 (z - 0.4 m)^2 + 1.2 mm, Nguyen et al., 3DIMPVT 2012).
double pixel_radius_m(double resolution_m);

}  // namespace kintsugi::segmenter

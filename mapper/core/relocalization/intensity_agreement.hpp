#pragma once
// Whether two images show the same texture, given the poses of their cameras.

#include <optional>

#include <opencv2/core.hpp>

#include "mapper/core/frame/surface_map.hpp"

namespace kintsugi::mapper {

/// Normalised correlation, -1..1, of the intensities of a frame C and of a keyframe K at the same
/// surface points; independent of exposure. The images have the sizes of the surfaces. Nothing if
/// the overlap is too small, or the texture so weak that the result would be the correlation of
/// noise.
std::optional<double> intensity_agreement(const SurfaceMap& surface_C,
                                          const cv::Mat_<std::uint8_t>& intensity_C,
                                          const SurfaceMap& surface_K,
                                          const cv::Mat_<std::uint8_t>& intensity_K,
                                          const Pose& X_KC);

}  // namespace kintsugi::mapper

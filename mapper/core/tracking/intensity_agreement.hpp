#pragma once
// Do two pictures show the same thing, if their cameras are where they are said to be?

#include <optional>

#include <opencv2/core.hpp>

#include "mapper/core/frame/surface_map.hpp"

namespace kintsugi::mapper {

/// Normalised correlation, -1..1, of the intensities that a frame C and a keyframe K measured of
/// the same surface points: it does not mind exposure. The images have the sizes of the surfaces.
/// Nothing when the views have too little in common, or so little texture that the correlation
/// would be one of noise.
std::optional<double> intensity_agreement(const SurfaceMap& surface_C,
                                          const cv::Mat_<std::uint8_t>& intensity_C,
                                          const SurfaceMap& surface_K,
                                          const cv::Mat_<std::uint8_t>& intensity_K,
                                          const Pose& X_KC);

}  // namespace kintsugi::mapper

#pragma once

#include <opencv2/core.hpp>

#include "mapper/openni2_driver/plugin/oni_driver_api.hpp"
#include "mapper/openni2_driver/recording/camera_imitation.hpp"

namespace kintsugi::mapper {

/// The image in a mode of another size, as of a PrimeSense camera: scaled to the width of the mode.
/// If the mode has a larger aspect ratio (height to width), the rows below the depth image are
/// magenta. Depth (CV_16UC1) keeps its values.
cv::Mat image_in_mode(const cv::Mat& image, cv::Size mode);

/// Depth of a camera beside the colour camera: shifted by 1/20 of the width.
cv::Mat unregistered(const cv::Mat& depth);

/// Damages a depth frame if `imitation` demands it for this frame.
/// @param number of the frame, from 1
void spoil(OniFrame& frame, int number, const CameraImitation& imitation);

}  // namespace kintsugi::mapper

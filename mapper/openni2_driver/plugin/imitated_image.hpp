#pragma once

#include <opencv2/core.hpp>

#include "mapper/openni2_driver/plugin/oni_driver_api.hpp"
#include "mapper/openni2_driver/recording/camera_imitation.hpp"

namespace kintsugi::mapper {

/// An image as a PrimeSense camera gives it in a mode of another size: scaled to the mode's width;
/// where the mode is taller in shape, what the depth camera does not see (magenta) is below.
/// Depth (CV_16UC1) keeps its values.
cv::Mat image_in_mode(const cv::Mat& image, cv::Size mode);

/// Depth as a camera beside the colour camera sees it: shifted by a 20th of the width.
cv::Mat unregistered(const cv::Mat& depth);

/// Makes of a depth frame what a camera should not send, when it is its turn.
/// @param number of the frame, from 1.
void spoil(OniFrame& frame, int number, const CameraImitation& imitation);

}  // namespace kintsugi::mapper

#pragma once
// OpenNI2's frames to images of our own.

#include <OpenNI.h>
#include <opencv2/core.hpp>

namespace kintsugi::mapper {

/// A copy of a depth frame, whole: what cropping left out is 0.
/// @throws std::runtime_error for another pixel format, another size than its mode's, or fewer
/// bytes than that needs.
cv::Mat_<std::uint16_t> copy_depth(const openni::VideoFrameRef& frame, bool mirrored);

/// A copy of a colour frame in any of OpenNI2's formats as RGB, on the pixels of a depth image of
/// `depth_size` registered to it (see registered_part()); what cropping left out is black.
/// @throws std::runtime_error as above.
cv::Mat_<cv::Vec3b> copy_color(const openni::VideoFrameRef& frame, bool mirrored,
                               cv::Size depth_size);

}  // namespace kintsugi::mapper

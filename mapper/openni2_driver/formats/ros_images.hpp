#pragma once
// Images of ROS messages.

#include <string>

#include <opencv2/core.hpp>

#include "mapper/openni2_driver/formats/ros_messages.hpp"

namespace kintsugi::mapper::ros1 {

/// Encodings 16UC1 and mono16 as CV_16UC1, 32FC1 (metres) as CV_32FC1.
/// @throws std::runtime_error naming `what`, the encoding or size, and what was expected
cv::Mat depth_of(const Image& message, cv::Size expected, const std::string& what);

/// Of the transport compressedDepth: a PNG behind 12 bytes, of 16 bits or of inverse depths.
/// @throws std::runtime_error as above
cv::Mat depth_of(const CompressedImage& message, cv::Size expected, const std::string& what);

/// Encodings rgb8, bgr8, rgba8, bgra8, mono8; red first.
/// @throws std::runtime_error as above
cv::Mat_<cv::Vec3b> color_of(const Image& message, cv::Size expected, const std::string& what);

/// JPEG or PNG.
/// @throws std::runtime_error as above
cv::Mat_<cv::Vec3b> color_of(const CompressedImage& message, cv::Size expected,
                             const std::string& what);

}  // namespace kintsugi::mapper::ros1

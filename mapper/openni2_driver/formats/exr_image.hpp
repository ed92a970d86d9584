#pragma once
// Depth images in OpenEXR, as Record3D exports them.

#include <filesystem>

#include <opencv2/core.hpp>

namespace kintsugi::mapper {

/// @throws std::runtime_error naming the file when it is not an OpenEXR image
cv::Size exr_size(const std::filesystem::path& file);

/// The channel Z or Y, or else R, as 32-bit floats in the unit of the file.
/// @throws std::runtime_error naming the file, and its size or channels and what was expected
cv::Mat_<float> decode_exr(const std::filesystem::path& file, cv::Size expected);

}  // namespace kintsugi::mapper

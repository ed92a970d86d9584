#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <opencv2/core.hpp>

namespace kintsugi::viewer {

/// Writes a PNG file that is complete or absent, also after an error.
/// @throws std::system_error naming the file and the reason
void write_png(const std::filesystem::path& path, const cv::Mat3b& image);

/// Encodes a picture as JPEG; `quality` in [0, 100].
std::vector<std::uint8_t> encode_jpeg(const cv::Mat3b& image, int quality);

}  // namespace kintsugi::viewer

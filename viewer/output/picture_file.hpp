#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <opencv2/core.hpp>

namespace kintsugi::viewer {

/// Writes a PNG that is whole or absent. Throws std::system_error naming the file and the reason.
void write_png(const std::filesystem::path& path, const cv::Mat3b& image);

/// The picture as a JPEG file in memory; `quality` in [0, 100].
std::vector<std::uint8_t> encode_jpeg(const cv::Mat3b& image, int quality);

}  // namespace kintsugi::viewer

#pragma once
// Decodes PNG and JPEG images, and refuses truncated files and other types, which OpenCV would
// accept. The size in the header is compared with the expected size and the number of bytes before
// memory is allocated.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace kintsugi::mapper {

/// A 16-bit single-channel image (PNG).
/// @param what names the image in errors
/// @throws std::runtime_error naming `what`, its size and type, and what was expected
cv::Mat_<std::uint16_t> decode_depth(std::span<const std::uint8_t> bytes, cv::Size expected,
                                     const std::string& what);

/// An 8-bit image of one, three or four channels (PNG or JPEG), red first.
/// @throws std::runtime_error as above
cv::Mat_<cv::Vec3b> decode_color(std::span<const std::uint8_t> bytes, cv::Size expected,
                                 const std::string& what);

/// @throws std::runtime_error naming the file when it cannot be read or is empty
std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file);

}  // namespace kintsugi::mapper

#pragma once
// Images as .klg and .sens files have them: raw, or compressed with zlib or as JPEG and PNG.

#include <cstdint>
#include <span>
#include <string>

#include <opencv2/core.hpp>

namespace kintsugi::mapper {

/// 16 bits a pixel, raw where the number of bytes says so, else compressed with zlib.
/// @throws std::runtime_error naming `what` when it is not exactly an image of this size
cv::Mat_<std::uint16_t> unpack_depth(std::span<const std::uint8_t> bytes, cv::Size size,
                                     const std::string& what);

/// Whether unpack_depth() would find an image of this size, told without taking memory for it.
bool can_be_depth(std::span<const std::uint8_t> bytes, cv::Size size);

/// Raw with red first where the number of bytes says so, else JPEG or PNG.
/// @throws std::runtime_error as above
cv::Mat_<cv::Vec3b> unpack_color(std::span<const std::uint8_t> bytes, cv::Size size,
                                 const std::string& what);

/// Number of bytes that zlib's data become, counted without keeping them; -1: not zlib's data.
std::int64_t inflated_size(std::span<const std::uint8_t> bytes);

}  // namespace kintsugi::mapper

#pragma once
// The header of a compressed image, read without decoding it.

#include <cstdint>
#include <optional>
#include <span>

#include <opencv2/core.hpp>

namespace kintsugi::mapper {

struct ImageHeader {
  enum class Format { kPng, kJpeg };
  Format format = Format::kPng;
  cv::Size size;
  int bits_per_pixel = 0;  ///< of all channels
};

/// nullopt when `bytes` are neither PNG nor JPEG, or end within the header.
std::optional<ImageHeader> read_image_header(std::span<const std::uint8_t> bytes);

}  // namespace kintsugi::mapper

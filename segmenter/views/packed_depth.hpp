#pragma once
// A small depth image, compressed without loss.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace kintsugi::segmenter {

/// Differences along the rows, in two planes of bytes, compressed by zlib. The same image gives the
/// same bytes. @param width of a row; depth_mm has whole rows
std::vector<std::uint8_t> pack_depth(std::span<const std::uint16_t> depth_mm, std::size_t width);

/// The image of so many samples that was packed.
/// @throws std::invalid_argument with the reason when these are not the bytes of such an image
std::vector<std::uint16_t> unpack_depth(std::span<const std::uint8_t> packed, std::size_t width,
                                        std::size_t height);

}  // namespace kintsugi::segmenter

#include "mapper/openni2_driver/formats/image_header.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace kintsugi::mapper {
namespace {

using Bytes = std::span<const std::uint8_t>;

std::uint32_t big_endian(Bytes bytes, std::size_t place, std::size_t num_bytes) {
  std::uint32_t value = 0;
  for (const std::uint8_t byte : bytes.subspan(place, num_bytes)) value = value << 8U | byte;
  return value;
}

int channels_of_png(int color_type) {
  switch (color_type) {
    case 2:
      return 3;
    case 4:
      return 2;
    case 6:
      return 4;
    default:
      return 1;
  }
}

/// Signature, bytes and type of the first chunk, width, height, bit depth, colour type.
std::optional<ImageHeader> read_png_header(Bytes bytes) {
  constexpr std::size_t kEnd = 26;
  if (bytes.size() < kEnd) return std::nullopt;
  const std::uint32_t width = big_endian(bytes, 16, 4);
  const std::uint32_t height = big_endian(bytes, 20, 4);
  constexpr std::uint32_t kMax = std::numeric_limits<std::int32_t>::max();
  if (width > kMax || height > kMax) return std::nullopt;
  return ImageHeader{.format = ImageHeader::Format::kPng,
                     .size = {static_cast<int>(width), static_cast<int>(height)},
                     .bits_per_pixel = bytes[24] * channels_of_png(bytes[25])};
}

bool is_frame_marker(std::uint8_t marker) {
  constexpr std::uint8_t kHuffmanTables = 0xC4;
  constexpr std::uint8_t kReserved = 0xC8;
  constexpr std::uint8_t kArithmeticTables = 0xCC;
  return marker >= 0xC0 && marker <= 0xCF && marker != kHuffmanTables && marker != kReserved &&
         marker != kArithmeticTables;
}

/// Segments of marker, size and contents, up to the one that begins the frame: bits of a sample,
/// height, width, number of channels.
std::optional<ImageHeader> read_jpeg_header(Bytes bytes) {
  constexpr std::uint8_t kMark = 0xFF;
  constexpr std::size_t kFrameBytes = 10;
  std::size_t place = 2;
  while (place + kFrameBytes <= bytes.size() && bytes[place] == kMark) {
    const std::uint8_t marker = bytes[place + 1];
    if (marker == kMark) {  // a mark may be filled up with more of them
      ++place;
    } else if (is_frame_marker(marker)) {
      return ImageHeader{.format = ImageHeader::Format::kJpeg,
                         .size = {static_cast<int>(big_endian(bytes, place + 7, 2)),
                                  static_cast<int>(big_endian(bytes, place + 5, 2))},
                         .bits_per_pixel = bytes[place + 4] * bytes[place + 9]};
    } else {
      place += 2 + big_endian(bytes, place + 2, 2);
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<ImageHeader> read_image_header(Bytes bytes) {
  constexpr std::array<std::uint8_t, 8> kPng = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  constexpr std::array<std::uint8_t, 2> kJpeg = {0xFF, 0xD8};
  const auto begins_with = [bytes](const auto& start) {
    return bytes.size() >= start.size() && std::equal(start.begin(), start.end(), bytes.begin());
  };
  if (begins_with(kPng)) return read_png_header(bytes);
  if (begins_with(kJpeg)) return read_jpeg_header(bytes);
  return std::nullopt;
}

}  // namespace kintsugi::mapper

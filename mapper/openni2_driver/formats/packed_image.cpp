#include "mapper/openni2_driver/formats/packed_image.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <zlib.h>

#include "mapper/openni2_driver/formats/image_decoder.hpp"

namespace kintsugi::mapper {
namespace {

using Bytes = std::span<const std::uint8_t>;

std::string text(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

std::size_t num_pixels(cv::Size size) {
  return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
}

}  // namespace

bool can_be_depth(Bytes bytes, cv::Size size) {
  const std::size_t num_bytes = num_pixels(size) * sizeof(std::uint16_t);
  return bytes.size() == num_bytes || inflated_size(bytes) == static_cast<std::int64_t>(num_bytes);
}

cv::Mat_<std::uint16_t> unpack_depth(Bytes bytes, cv::Size size, const std::string& what) {
  const std::size_t num_bytes = num_pixels(size) * sizeof(std::uint16_t);
  // Before memory is taken for what the file only says: zlib makes at most 1032 bytes of one.
  constexpr std::size_t kMaxRatio = 1100;
  auto inflated = static_cast<uLongf>(num_bytes);
  int result = Z_DATA_ERROR;
  cv::Mat_<std::uint16_t> depth;
  if (bytes.size() == num_bytes) {
    depth.create(size);
    std::ranges::copy(bytes, depth.data);
    return depth;
  }
  if (num_bytes / kMaxRatio <= bytes.size()) {
    depth.create(size);
    result = uncompress(depth.data, &inflated, bytes.data(), bytes.size());
  }
  if (result != Z_OK || inflated != num_bytes) {
    throw std::runtime_error(what + ": " + std::to_string(bytes.size()) +
                             " bytes of depth are neither raw nor compressed with zlib, expected " +
                             text(size) + " pixels");
  }
  return depth;
}

cv::Mat_<cv::Vec3b> unpack_color(Bytes bytes, cv::Size size, const std::string& what) {
  if (bytes.size() != num_pixels(size) * sizeof(cv::Vec3b)) return decode_color(bytes, size, what);
  cv::Mat_<cv::Vec3b> color(size);
  std::ranges::copy(bytes, color.data);
  return color;
}

std::int64_t inflated_size(Bytes bytes) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return -1;
  stream.next_in = const_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  std::array<Bytef, 1U << 15U> sink{};
  int result = Z_OK;
  while (result == Z_OK) {
    stream.next_out = sink.data();
    stream.avail_out = static_cast<uInt>(sink.size());
    result = inflate(&stream, Z_NO_FLUSH);
  }
  const auto size = static_cast<std::int64_t>(stream.total_out);
  inflateEnd(&stream);
  return result == Z_STREAM_END ? size : -1;
}

}  // namespace kintsugi::mapper

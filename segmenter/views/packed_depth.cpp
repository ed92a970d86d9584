#include "segmenter/views/packed_depth.hpp"

#include <stdexcept>
#include <string>

#include <zlib.h>

namespace kintsugi::segmenter {
namespace {

constexpr int kLevel = 1;  // the next ones take twice the time and save some per cent

}  // namespace

std::vector<std::uint8_t> pack_depth(std::span<const std::uint16_t> depth_mm, std::size_t width) {
  const std::size_t count = depth_mm.size();
  std::vector<std::uint8_t> planes(2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t before = i % width == 0 ? 0 : depth_mm[i - 1];
    const auto difference = static_cast<std::uint16_t>(depth_mm[i] - before);
    planes[i] = static_cast<std::uint8_t>(difference & 0xFFU);
    planes[count + i] = static_cast<std::uint8_t>(difference >> 8U);
  }
  uLongf size = compressBound(planes.size());
  std::vector<std::uint8_t> packed(size);
  if (compress2(packed.data(), &size, planes.data(), planes.size(), kLevel) != Z_OK) {
    throw std::runtime_error("zlib cannot compress a depth image: no memory");
  }
  packed.resize(size);
  packed.shrink_to_fit();
  return packed;
}

std::vector<std::uint16_t> unpack_depth(std::span<const std::uint8_t> packed, std::size_t width,
                                        std::size_t height) {
  const std::size_t count = width * height;
  std::vector<std::uint8_t> planes(2 * count);
  uLongf size = planes.size();
  uLong used = packed.size();
  const int result = uncompress2(planes.data(), &size, packed.data(), &used);
  if (result != Z_OK || size != planes.size() || used != packed.size()) {
    throw std::invalid_argument("its " + std::to_string(packed.size()) +
                                " bytes are not a depth image of " + std::to_string(width) + " x " +
                                std::to_string(height) + " pixels");
  }
  std::vector<std::uint16_t> depth_mm(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t before = i % width == 0 ? 0 : depth_mm[i - 1];
    const auto difference = static_cast<std::uint16_t>(planes[i] | (planes[count + i] << 8U));
    depth_mm[i] = static_cast<std::uint16_t>(before + difference);
  }
  return depth_mm;
}

}  // namespace kintsugi::segmenter

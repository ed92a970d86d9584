#include "mapper/openni2_driver/formats/ros_images.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <stdexcept>

#include <opencv2/imgproc.hpp>

#include "mapper/openni2_driver/formats/image_decoder.hpp"

namespace kintsugi::mapper::ros1 {
namespace {

std::string text(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

/// The pixels of the message, not copied.
cv::Mat view(const Image& message, int type, cv::Size expected, const std::string& what) {
  const cv::Size size(static_cast<int>(message.width), static_cast<int>(message.height));
  if (size != expected) {
    throw std::runtime_error(what + ": is " + text(size) + ", expected " + text(expected));
  }
  const std::size_t row_bytes = static_cast<std::size_t>(size.width) * CV_ELEM_SIZE(type);
  if (message.step < row_bytes ||
      message.data.size() < static_cast<std::size_t>(message.step) * message.height) {
    throw std::runtime_error(what + ": has " + std::to_string(message.data.size()) +
                             " bytes, expected " + text(size) + " pixels of " +
                             std::to_string(CV_ELEM_SIZE(type)) + " bytes");
  }
  return {size, type, const_cast<std::uint8_t*>(message.data.data()), message.step};
}

[[noreturn]] void fail(const Image& message, const char* expected, const std::string& what) {
  throw std::runtime_error(what + ": its encoding is '" + plain(message.encoding) + "', expected " +
                           expected);
}

/// Bytes within 16- and 32-bit pixels change places.
cv::Mat swapped(const cv::Mat& pixels) {
  cv::Mat result = pixels.clone();
  for (int y = 0; y < result.rows; ++y) {
    std::uint8_t* row = result.ptr(y);
    const std::size_t bytes = result.elemSize();
    for (int x = 0; x < result.cols; ++x, row += bytes) std::reverse(row, row + bytes);
  }
  return result;
}

}  // namespace

cv::Mat depth_of(const Image& message, cv::Size expected, const std::string& what) {
  int type = -1;
  if (message.encoding == "16UC1" || message.encoding == "mono16") type = CV_16UC1;
  if (message.encoding == "32FC1") type = CV_32FC1;
  if (type < 0) fail(message, "16UC1, mono16 or 32FC1", what);
  const cv::Mat pixels = view(message, type, expected, what);
  const bool is_big = message.is_bigendian != 0;
  return is_big == (std::endian::native == std::endian::big) ? pixels.clone() : swapped(pixels);
}

cv::Mat depth_of(const CompressedImage& message, cv::Size expected, const std::string& what) {
  struct Header {
    std::int32_t format;
    float a;  // depth = a / (value - b), for floating point
    float b;
  };
  Header header{};
  if (message.data.size() <= sizeof(header)) {
    throw std::runtime_error(what + ": has " + std::to_string(message.data.size()) +
                             " bytes, expected a compressedDepth");
  }
  std::memcpy(&header, message.data.data(), sizeof(header));
  const std::span<const std::uint8_t> png = std::span(message.data).subspan(sizeof(header));
  cv::Mat_<std::uint16_t> values = decode_depth(png, expected, what);
  if (!message.format.starts_with("32FC1")) return values;
  cv::Mat_<float> depth_m(values.size());
  std::transform(values.begin(), values.end(), depth_m.begin(), [&](std::uint16_t value) {
    return value == 0 ? 0.0F : header.a / (static_cast<float>(value) - header.b);
  });
  return depth_m;
}

cv::Mat_<cv::Vec3b> color_of(const Image& message, cv::Size expected, const std::string& what) {
  struct Encoding {
    const char* name;
    int type;
    int conversion;  // -1: none
  };
  constexpr std::array<Encoding, 6> kEncodings = {{{"rgb8", CV_8UC3, -1},
                                                   {"bgr8", CV_8UC3, cv::COLOR_BGR2RGB},
                                                   {"rgba8", CV_8UC4, cv::COLOR_RGBA2RGB},
                                                   {"bgra8", CV_8UC4, cv::COLOR_BGRA2RGB},
                                                   {"mono8", CV_8UC1, cv::COLOR_GRAY2RGB},
                                                   {"8UC1", CV_8UC1, cv::COLOR_GRAY2RGB}}};
  const auto encoding = std::ranges::find_if(
      kEncodings, [&](const Encoding& each) { return message.encoding == each.name; });
  if (encoding == kEncodings.end()) fail(message, "rgb8, bgr8, rgba8, bgra8 or mono8", what);
  const cv::Mat pixels = view(message, encoding->type, expected, what);
  if (encoding->conversion < 0) return pixels.clone();
  cv::Mat_<cv::Vec3b> rgb;
  cv::cvtColor(pixels, rgb, encoding->conversion);
  return rgb;
}

cv::Mat_<cv::Vec3b> color_of(const CompressedImage& message, cv::Size expected,
                             const std::string& what) {
  return decode_color(message.data, expected, what);
}

}  // namespace kintsugi::mapper::ros1

#include "mapper/openni2_driver/formats/image_decoder.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "mapper/openni2_driver/formats/image_header.hpp"

namespace kintsugi::mapper {
namespace {

using Bytes = std::span<const std::uint8_t>;

bool contains(Bytes bytes, std::string_view text) {
  return std::search(bytes.begin(), bytes.end(), text.begin(), text.end(),
                     [](std::uint8_t byte, char c) {
                       return byte == static_cast<std::uint8_t>(c);
                     }) != bytes.end();
}

/// libjpeg fills what is missing of a cut-off file with grey and says nothing to us; libpng keeps
/// the rows it has. Both formats have an end mark, near the end of the file.
bool is_cut_off(ImageHeader::Format format, Bytes bytes) {
  constexpr std::size_t kTail = 64;
  const Bytes tail = bytes.last(std::min(kTail, bytes.size()));
  return !contains(tail, format == ImageHeader::Format::kPng ? "IEND" : "\xff\xd9");
}

/// Neither format says more with fewer bytes: PNG deflates at most 1032 to 1; JPEG has at least a
/// bit for each 64 pixels of a channel.
bool can_be_in(const ImageHeader& header, std::size_t num_bytes) {
  constexpr std::int64_t kMaxRatio = 1100;
  const std::int64_t row_bytes = (std::int64_t{header.size.width} * header.bits_per_pixel + 7) / 8;
  return row_bytes * header.size.height <= kMaxRatio * static_cast<std::int64_t>(num_bytes);
}

std::string text(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

/// Before memory is taken for the pixels that the file says it has.
void check_header(Bytes bytes, cv::Size expected, const std::string& what) {
  if (bytes.empty()) throw std::runtime_error(what + ": is empty, expected an image");
  const auto header = read_image_header(bytes);
  if (!header) throw std::runtime_error(what + ": cannot be decoded: expected PNG or JPEG");
  if (header->size != expected) {
    throw std::runtime_error(what + ": is " + text(header->size) + ", expected " + text(expected));
  }
  if (is_cut_off(header->format, bytes) || !can_be_in(*header, bytes.size())) {
    throw std::runtime_error(what + ": is cut off after " + std::to_string(bytes.size()) +
                             " bytes");
  }
}

std::string describe(const cv::Mat& image) {
  return text(image.size()) + ", " + std::to_string(8 * image.elemSize1()) + " bit, " +
         std::to_string(image.channels()) + (image.channels() == 1 ? " channel" : " channels");
}

cv::Mat decode(Bytes bytes, cv::Size expected, const std::string& what) {
  check_header(bytes, expected, what);
  cv::Mat image;
  try {
    const cv::Mat buffer(1, static_cast<int>(bytes.size()), CV_8UC1,
                         const_cast<std::uint8_t*>(bytes.data()));
    image = cv::imdecode(buffer, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& error) {
    throw std::runtime_error(what + ": cannot be decoded: " + error.what());
  }
  if (image.empty()) throw std::runtime_error(what + ": cannot be decoded as an image");
  return image;
}

void require(bool right, const cv::Mat& image, cv::Size size, const char* type,
             const std::string& what) {
  if (right && image.size() == size) return;
  throw std::runtime_error(what + ": is " + describe(image) + ", expected " + text(size) + ", " +
                           type);
}

}  // namespace

cv::Mat_<std::uint16_t> decode_depth(Bytes bytes, cv::Size expected, const std::string& what) {
  cv::Mat image = decode(bytes, expected, what);
  require(image.type() == CV_16UC1, image, expected, "16 bit, 1 channel", what);
  return image;
}

cv::Mat_<cv::Vec3b> decode_color(Bytes bytes, cv::Size expected, const std::string& what) {
  const cv::Mat image = decode(bytes, expected, what);
  const int channels = image.channels();
  require(image.depth() == CV_8U && (channels == 1 || channels == 3 || channels == 4), image,
          expected, "8 bit, 1, 3 or 4 channels", what);
  constexpr std::array<int, 5> kToRgb = {0, cv::COLOR_GRAY2RGB, 0, cv::COLOR_BGR2RGB,
                                         cv::COLOR_BGRA2RGB};
  cv::Mat_<cv::Vec3b> rgb;
  cv::cvtColor(image, rgb, kToRgb.at(static_cast<std::size_t>(channels)));
  return rgb;
}

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file) {
  std::error_code failure;  // also of a folder
  const std::uintmax_t size = std::filesystem::file_size(file, failure);
  std::ifstream stream(file, std::ios::binary);
  if (failure || !stream) throw std::runtime_error(file.string() + ": cannot be read");
  std::vector<std::uint8_t> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!stream) throw std::runtime_error(file.string() + ": reading it failed");
  return bytes;
}

}  // namespace kintsugi::mapper

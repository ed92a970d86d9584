#include "mapper/openni2_driver/formats/image_files.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "mapper/openni2_driver/formats/exr_image.hpp"
#include "mapper/openni2_driver/formats/image_decoder.hpp"
#include "mapper/openni2_driver/formats/image_header.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

bool is_exr(const fs::path& file) { return file.extension() == ".exr"; }

bool has_bytes(const fs::path& file) {
  std::error_code failure;
  return fs::file_size(file, failure) > 0 && !failure;
}

cv::Size size_of_image(const fs::path& file) {
  if (is_exr(file)) return exr_size(file);
  const auto header = read_image_header(read_bytes(file));
  if (!header) throw std::runtime_error(file.string() + ": expected PNG or JPEG");
  return header->size;
}

}  // namespace

ImageFiles::ImageFiles(Files files, cv::Size depth_size, cv::Size color_size)
    : files_(std::move(files)), depth_size_(depth_size), color_size_(color_size) {}

cv::Mat ImageFiles::depth(int index) {
  const fs::path& file = files_.depth.at(static_cast<std::size_t>(index));
  cv::Mat depth = is_exr(file) ? cv::Mat(decode_exr(file, depth_size_))
                               : decode_depth(read_bytes(file), depth_size_, file.string());
  if (files_.confidence.empty()) return depth;
  const fs::path& sure = files_.confidence.at(static_cast<std::size_t>(index));
  const cv::Mat_<cv::Vec3b> confidence = decode_color(read_bytes(sure), depth_size_, sure.string());
  cv::Mat guessed;
  cv::inRange(confidence, cv::Scalar::all(0), cv::Scalar::all(0), guessed);
  depth.setTo(0, guessed);
  return depth;
}

cv::Mat_<cv::Vec3b> ImageFiles::color(int index) {
  const fs::path& file = files_.color.at(static_cast<std::size_t>(index));
  return decode_color(read_bytes(file), color_size_, file.string());
}

bool ImageFiles::depth_is_missing(int index) const {
  return !has_bytes(files_.depth.at(static_cast<std::size_t>(index)));
}

bool ImageFiles::color_is_missing(int index) const {
  return !has_bytes(files_.color.at(static_cast<std::size_t>(index)));
}

cv::Size size_of_images(const std::vector<fs::path>& files) {
  const auto present = std::ranges::find_if(files, has_bytes);
  if (present == files.end()) {
    throw std::runtime_error((files.empty() ? "no image" : files.front().string()) +
                             ": missing, like every other image of the recording");
  }
  return size_of_image(*present);
}

}  // namespace kintsugi::mapper

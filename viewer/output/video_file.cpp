#include "viewer/output/video_file.hpp"

#include <stdexcept>
#include <string>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::viewer {
namespace {

std::string text_of(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace

void check_video_name(const std::filesystem::path& path) {
  require(path.extension() == ".mp4", "video file", path, "a name that ends in .mp4");
}

VideoFile::VideoFile(const std::filesystem::path& path, cv::Size size, double pictures_per_s)
    : path_((check_video_name(path), path)),
      size_(size),
      file_(path),
      encoder_(file_.partial_path(), size, pictures_per_s) {}

void VideoFile::add(const cv::Mat3b& image) {
  require(image.size() == size_, "video frame", text_of(image.size()), text_of(size_));
  require(!has_failed_, "the video lacks a frame that could not be written");
  has_failed_ = true;
  encoder_.add(image);
  has_failed_ = false;
  ++frames_;
}

void VideoFile::finish() {
  if (has_failed_) {
    throw std::runtime_error("video '" + path_.string() +
                             "' lacks a frame that could not be written: is the disk full?");
  }
  if (frames_ == 0) return;
  encoder_.finish();
  file_.commit();
}

}  // namespace kintsugi::viewer

#include "viewer/output/video_file.hpp"

#include <stdexcept>
#include <string>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::viewer {
namespace {

const std::filesystem::path& require_mp4(const std::filesystem::path& path) {
  require(path.extension() == ".mp4", "video file", path, "a name that ends in .mp4");
  return path;
}

std::string text_of(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

/// The count in the container's index, which is written last; OpenCV knows no other. When the index
/// is truncated, the count may be there without the positions of the frames: so the first and the
/// last frame are read, too, and the count is 0 when that fails.
std::int64_t count_frames(const std::filesystem::path& path) {
  cv::VideoCapture video(path.string(), cv::CAP_FFMPEG);
  if (!video.isOpened() || !video.grab()) return 0;
  const double count = video.get(cv::CAP_PROP_FRAME_COUNT);
  const bool has_last =
      count <= 1.0 || (video.set(cv::CAP_PROP_POS_FRAMES, count - 1.0) && video.grab());
  return has_last ? static_cast<std::int64_t>(count) : 0;
}

}  // namespace

VideoFile::VideoFile(const std::filesystem::path& path, cv::Size size, double frames_per_s)
    : path_(require_mp4(path)),
      size_(size),
      file_(path),
      writer_(file_.partial_path().string(), cv::CAP_FFMPEG,
              cv::VideoWriter::fourcc('m', 'p', '4', 'v'), frames_per_s, size) {
  if (!writer_.isOpened()) throw std::runtime_error("cannot write video '" + path.string() + "'");
}

void VideoFile::add(const cv::Mat3b& image) {
  require(image.size() == size_, "video frame", text_of(image.size()), text_of(size_));
  writer_.write(image);
  ++frames_;
}

void VideoFile::finish() {
  writer_.release();
  if (frames_ == 0) return;
  const std::int64_t found = count_frames(file_.partial_path());
  if (found != frames_) {
    throw std::runtime_error("video '" + path_.string() + "' has " + std::to_string(found) +
                             " of " + std::to_string(frames_) + " frames: is the disk full?");
  }
  file_.commit();
}

}  // namespace kintsugi::viewer

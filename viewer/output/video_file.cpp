#include "viewer/output/video_file.hpp"

#include <stdexcept>
#include <string>

namespace kintsugi::viewer {
namespace {

const std::filesystem::path& require_mp4(const std::filesystem::path& path) {
  if (path.extension() != ".mp4") {
    throw std::invalid_argument("video file is '" + path.string() + "', expected a name in .mp4");
  }
  return path;
}

/// OpenCV knows no other way to count than the container's index, which is written last. Of an
/// index that is cut short the count may be there and the places of the frames not: then neither
/// the first nor the last is found.
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
  if (image.size() != size_) {
    throw std::invalid_argument("video frame is " + std::to_string(image.cols) + "x" +
                                std::to_string(image.rows) + ", expected " +
                                std::to_string(size_.width) + "x" + std::to_string(size_.height));
  }
  writer_.write(image);
  ++frames_;
}

void VideoFile::finish() {
  writer_.release();
  if (frames_ == 0) return;
  const std::int64_t found = count_frames(file_.partial_path());
  if (found != frames_) {
    throw std::runtime_error("video '" + path_.string() + "' holds " + std::to_string(found) +
                             " of " + std::to_string(frames_) + " frames: is the disk full?");
  }
  file_.commit();
}

}  // namespace kintsugi::viewer

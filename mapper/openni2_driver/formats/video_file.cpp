#include "mapper/openni2_driver/formats/video_file.hpp"

#include <stdexcept>
#include <string>

#include <opencv2/imgproc.hpp>

namespace kintsugi::mapper {

VideoFile::VideoFile(const std::filesystem::path& file) : file_(file) {
  open();
  size_ = {static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH)),
           static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT))};
}

cv::Mat_<cv::Vec3b> VideoFile::picture(int index) {
  const std::string what = file_.string() + ": picture " + std::to_string(index);
  // Seeking depends on the video's key frames and is not exact in all of them: count instead.
  if (index < next_) open();
  while (next_ <= index) {
    if (!capture_.grab()) throw std::runtime_error(what + " cannot be decoded");
    ++next_;
  }
  cv::Mat bgr;
  if (!capture_.retrieve(bgr) || bgr.type() != CV_8UC3) {
    throw std::runtime_error(what + " cannot be decoded as colour");
  }
  cv::Mat_<cv::Vec3b> rgb;
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  return rgb;
}

void VideoFile::open() {
  next_ = 0;
  try {
    if (capture_.open(file_.string(), cv::CAP_FFMPEG)) {
      capture_.set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
      return;
    }
  } catch (const cv::Exception& error) {
    throw std::runtime_error(file_.string() + ": cannot be read as a video: " + error.what());
  }
  throw std::runtime_error(file_.string() + ": cannot be read as a video");
}

}  // namespace kintsugi::mapper

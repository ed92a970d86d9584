#pragma once

#include <filesystem>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

namespace kintsugi::mapper {

/// The pictures of a video, as the camera took them: turned by no tag of the file.
class VideoFile {
 public:
  /// @throws std::runtime_error naming the file when it has no video that can be decoded
  explicit VideoFile(const std::filesystem::path& file);

  [[nodiscard]] cv::Size size() const { return size_; }

  /// Red first. One after another is fast; a step back begins at the file's beginning again.
  /// @throws std::runtime_error naming the file and the picture when there is no such picture
  [[nodiscard]] cv::Mat_<cv::Vec3b> picture(int index);

 private:
  void open();

  std::filesystem::path file_;
  cv::VideoCapture capture_;
  cv::Size size_;
  int next_ = 0;  ///< picture that grab() gets next
};

}  // namespace kintsugi::mapper

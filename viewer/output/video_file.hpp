#pragma once

#include <cstdint>
#include <filesystem>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "lcmtypes/base/atomic_file.hpp"

namespace kintsugi::viewer {

/// An MPEG-4 video file that is complete or absent, also after an error.
class VideoFile {
 public:
  /// Opens a temporary file beside `path`.
  /// @throws std::invalid_argument when `path` does not end in .mp4, std::runtime_error naming the
  ///   file when it cannot be written
  VideoFile(const std::filesystem::path& path, cv::Size size, double frames_per_s);

  /// Appends a picture.
  /// @throws std::invalid_argument when it has another size than the video
  void add(const cv::Mat3b& image);

  /// Closes the file, checks that its index is complete (FFmpeg does not report a full disk to
  /// OpenCV) and renames it to `path`. A video without frames is removed. Call once, after the last
  /// add().
  /// @throws std::runtime_error naming the file when it is not complete; it is removed then
  void finish();

  std::int64_t frames() const { return frames_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  cv::Size size_;
  AtomicFile file_;  // before the writer, so that it is destroyed after it
  cv::VideoWriter writer_;
  std::int64_t frames_ = 0;
};

}  // namespace kintsugi::viewer

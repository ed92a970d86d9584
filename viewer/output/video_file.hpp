#pragma once

#include <cstdint>
#include <filesystem>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "lcmtypes/base/atomic_file.hpp"

namespace kintsugi::viewer {

/// An MPEG-4 video that is whole under its name, or absent.
class VideoFile {
 public:
  /// Opens the partial file. Throws std::invalid_argument when `path` does not end in .mp4, and
  /// std::runtime_error naming the file when it cannot be written.
  VideoFile(const std::filesystem::path& path, cv::Size size, double frames_per_s);

  /// Appends a picture of the size given before.
  void add(const cv::Mat3b& image);

  /// Closes the file, checks that its index is whole (FFmpeg reports no full disk to
  /// OpenCV) and gives it its name. Without a frame there is no file. Throws std::runtime_error
  /// naming the file; nothing remains then. Call once, and add() no more.
  void finish();

  std::int64_t frames() const { return frames_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  cv::Size size_;
  AtomicFile file_;  // before the writer, which must be closed first
  cv::VideoWriter writer_;
  std::int64_t frames_ = 0;
};

}  // namespace kintsugi::viewer

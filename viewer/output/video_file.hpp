#pragma once

#include <cstdint>
#include <filesystem>

#include <opencv2/core.hpp>

#include "lcmtypes/base/atomic_file.hpp"
#include "viewer/output/h264_encoder.hpp"

namespace kintsugi::viewer {

/// @throws std::invalid_argument when the name does not end in .mp4
void check_video_name(const std::filesystem::path& path);

/// An H.264 video in an MP4 file that is complete or absent, also after an error.
class VideoFile {
 public:
  /// Opens a temporary file beside `path`.
  /// @throws std::invalid_argument as check_video_name()
  /// @throws std::runtime_error naming the file when it cannot be written, or when there is no
  /// H.264
  ///   encoder
  VideoFile(const std::filesystem::path& path, cv::Size size, double pictures_per_s);

  /// Appends a picture.
  /// @throws std::invalid_argument when it has another size than the video, std::runtime_error when
  ///   it cannot be written: the video is lost then
  void add(const cv::Mat3b& image);

  /// Closes the file and renames it to `path`. A video without frames is removed. Call once, after
  /// the last add().
  /// @throws std::runtime_error naming the file when it is not complete; it is removed then
  void finish();

  std::int64_t frames() const { return frames_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  cv::Size size_;
  AtomicFile file_;  // before the encoder, so that it is destroyed after it
  H264Encoder encoder_;
  bool has_failed_ = false;
  std::int64_t frames_ = 0;
};

}  // namespace kintsugi::viewer

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "viewer/output/attempts.hpp"
#include "viewer/output/video_file.hpp"

namespace kintsugi::viewer {

/// Records a video for as long as the disk has room.
///
/// A single failed write makes the whole file unreadable. So frames are left out, and that is
/// logged, while the free space is less than a frame and the index may need; the frames before and
/// after make a valid video.
class VideoRecorder {
 public:
  /// @throws as VideoFile
  VideoRecorder(const std::filesystem::path& path, cv::Size size, double pictures_per_s);

  /// Appends `count` pictures: the one before again and again, then this one. Pictures are left out
  /// when the disk is full.
  void add(const cv::Mat3b& figure, int count = 1);

  /// Closes the file. False, and logged, when the video is lost. Call once, after the last add().
  bool finish();

  /// Why the last frame or the video could not be written; empty when it was.
  const std::string& problem() const { return attempts_.problem(); }

 private:
  bool has_room() const;
  void append(const cv::Mat3b& picture);

  std::int64_t reserve_bytes_;
  VideoFile file_;
  Attempts attempts_;
  std::int64_t frames_left_out_ = 0;
  cv::Mat3b newest_;
};

}  // namespace kintsugi::viewer

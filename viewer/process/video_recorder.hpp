#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "viewer/output/video_file.hpp"
#include "viewer/process/attempts.hpp"

namespace kintsugi::viewer {

/// Records a video for as long as the disk has room.
///
/// FFmpeg reports no full disk to OpenCV, and what it could not write once makes the whole file
/// useless. So frames are left out, and that is reported, while the disk has less room than a frame
/// and the index may need; what is recorded before and after stays a video.
class VideoRecorder {
 public:
  /// Throws what VideoFile throws.
  VideoRecorder(const std::filesystem::path& path, cv::Size size, double frames_per_s);

  /// Appends a picture, or leaves it out.
  void add(const cv::Mat3b& figure);

  /// Closes the file; false, and reported, when it is lost. Call once, and add() no more.
  bool finish();

  std::int64_t frames_left_out() const { return frames_left_out_; }
  const std::string& problem() const { return attempts_.problem(); }

 private:
  bool has_room() const;

  std::int64_t reserve_bytes_;
  VideoFile file_;
  Attempts attempts_;
  std::int64_t frames_left_out_ = 0;
};

}  // namespace kintsugi::viewer

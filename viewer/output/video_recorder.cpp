#include "viewer/output/video_recorder.hpp"

#include <system_error>

#include <fmt/format.h>

#include "lcmtypes/base/logger.hpp"

namespace kintsugi::viewer {
namespace {

/// An uncompressed frame, plus 1 MiB for FFmpeg's buffer (256 kB) and the index.
std::int64_t reserve_for(cv::Size size) {
  constexpr std::int64_t kBuffersAndIndex = 1 << 20;
  return 3 * std::int64_t{size.width} * size.height + kBuffersAndIndex;
}

}  // namespace

VideoRecorder::VideoRecorder(const std::filesystem::path& path, cv::Size size,
                             double pictures_per_s)
    : reserve_bytes_(reserve_for(size)), file_(path, size, pictures_per_s) {}

/// Also true when the file system does not report its free space.
bool VideoRecorder::has_room() const {
  std::error_code unknown;
  const auto space = std::filesystem::space(
      file_.path().parent_path().empty() ? std::filesystem::path(".") : file_.path().parent_path(),
      unknown);
  return unknown || space.available >= static_cast<std::uintmax_t>(reserve_bytes_);
}

void VideoRecorder::add(const cv::Mat3b& figure, int count) {
  for (int i = 0; i + 1 < count; ++i) append(newest_.empty() ? figure : newest_);
  append(figure);
  newest_ = figure;
}

void VideoRecorder::append(const cv::Mat3b& picture) {
  if (!has_room()) {
    ++frames_left_out_;
    attempts_.note_failure(
        fmt::format("video {}: the disk has less than {} bytes left, frames are left out",
                    file_.path().string(), reserve_bytes_));
    return;
  }
  attempts_([&] { file_.add(picture); });
}

bool VideoRecorder::finish() {
  if (!attempts_([this] { file_.finish(); })) return false;
  if (file_.frames() > 0) spdlog::info("{} frames in {}", file_.frames(), file_.path().string());
  if (frames_left_out_ > 0) spdlog::warn("{} frames of the video were left out", frames_left_out_);
  return true;
}

}  // namespace kintsugi::viewer

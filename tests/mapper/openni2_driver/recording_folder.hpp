#pragma once
// A small recording in TUM layout on disk, right in every respect until a test spoils it.

#include <filesystem>
#include <fstream>
#include <string>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "gtest/gtest.h"

namespace kintsugi::mapper::test {

namespace fs = std::filesystem;

inline constexpr int kWidth = 64;
inline constexpr int kHeight = 48;
inline constexpr int kNumFrames = 5;

/// A value for each pixel and frame; zero now and then.
inline std::uint16_t raw_depth(int frame, int x, int y) {
  const int value = 500 + 100 * frame + 7 * x + 3 * y;
  return static_cast<std::uint16_t>((x + y + frame) % 11 == 0 ? 0 : value);
}

inline cv::Vec3b color_rgb(int frame, int x, int y) {
  return {static_cast<std::uint8_t>(4 * x), static_cast<std::uint8_t>(5 * y),
          static_cast<std::uint8_t>(20 * frame)};
}

inline cv::Mat_<std::uint16_t> raw_depth_image(int frame) {
  cv::Mat_<std::uint16_t> image(kHeight, kWidth);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) image(y, x) = raw_depth(frame, x, y);
  }
  return image;
}

inline cv::Mat_<cv::Vec3b> color_image(int frame) {
  cv::Mat_<cv::Vec3b> image(kHeight, kWidth);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) image(y, x) = color_rgb(frame, x, y);
  }
  return image;
}

inline void write_text(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

inline void write_color(const fs::path& file, const cv::Mat_<cv::Vec3b>& rgb) {
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  cv::imwrite(file.string(), bgr);
}

/// Removed with everything in it when it goes out of scope.
class RecordingFolder {
 public:
  explicit RecordingFolder(const std::string& camera = "50 51 31.5 23.5 64 48 1000\n",
                           int num_frames = kNumFrames) {
    std::string pattern = (fs::path(testing::TempDir()) / "recordingXXXXXX").string();
    path_ = mkdtemp(pattern.data());
    fs::create_directories(path_ / "depth");
    fs::create_directories(path_ / "rgb");
    std::string depth_list = "# timestamp filename\n";
    std::string color_list = "# timestamp filename\n";
    for (int i = 0; i < num_frames; ++i) {
      const std::string file = std::to_string(i) + ".png";
      cv::imwrite((path_ / "depth" / file).string(), raw_depth_image(i));
      write_color(path_ / "rgb" / file, color_image(i));
      depth_list += depth_time(i) + " depth/" + file + "\n";
      color_list += color_time(i) + " rgb/" + file + "\n";
    }
    write_text(path_ / "depth.txt", depth_list);
    write_text(path_ / "rgb.txt", color_list);
    write_text(path_ / "camera.txt", camera);
  }
  ~RecordingFolder() { fs::remove_all(path_); }
  RecordingFolder(const RecordingFolder&) = delete;
  RecordingFolder& operator=(const RecordingFolder&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }
  [[nodiscard]] std::string uri() const { return "folder://" + path_.string(); }

  static std::int64_t depth_utime(int frame) {
    return 1341836537655691 + std::int64_t{33333} * frame;
  }
  static std::int64_t color_utime(int frame) { return depth_utime(frame) - 29; }
  static std::string depth_time(int frame) { return seconds(depth_utime(frame)); }
  static std::string color_time(int frame) { return seconds(color_utime(frame)); }

 private:
  static std::string seconds(std::int64_t utime) {
    const std::string digits = std::to_string(utime);
    return digits.substr(0, digits.size() - 6) + "." + digits.substr(digits.size() - 6);
  }

  fs::path path_;
};

/// The message of the exception that `call` throws; fails the test when it throws none.
template <typename Exception, typename Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const Exception& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return "";
}

}  // namespace kintsugi::mapper::test

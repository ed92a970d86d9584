#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include <opencv2/core.hpp>

struct AVCodecContext;
struct AVFormatContext;
struct AVFrame;
struct AVPacket;
struct SwsContext;

namespace kintsugi::viewer {

/// Encodes pictures as H.264 (yuv420p, BT.709) into an MP4 file whose index is at its beginning, so
/// that browsers play it while they load it. With FFmpeg's libraries.
class H264Encoder {
 public:
  /// Opens the file; an odd last row or column of the pictures is cut off, yuv420p has none.
  /// @throws std::runtime_error with the reason when it cannot be opened or there is no encoder
  H264Encoder(const std::filesystem::path& file, cv::Size size, double pictures_per_s);
  ~H264Encoder();
  H264Encoder(const H264Encoder&) = delete;
  H264Encoder& operator=(const H264Encoder&) = delete;

  /// Appends a picture of the size of the file.
  /// @throws std::runtime_error with the reason when the file cannot be written
  void add(const cv::Mat3b& image);

  /// Writes what is left and the index, and closes the file. Call once, after the last add().
  /// @throws as add()
  void finish();

 private:
  struct Free {
    void operator()(AVCodecContext* context) const;
    void operator()(AVFormatContext* context) const;
    void operator()(AVFrame* frame) const;
    void operator()(AVPacket* packet) const;
    void operator()(SwsContext* context) const;
  };

  void open_encoder(cv::Size size, double pictures_per_s);
  void open_file();
  void encode(const AVFrame* frame);
  void check(int result, const std::string& action) const;

  std::filesystem::path path_;
  std::unique_ptr<AVFormatContext, Free> file_;
  std::unique_ptr<AVCodecContext, Free> encoder_;
  std::unique_ptr<AVFrame, Free> frame_;
  std::unique_ptr<AVPacket, Free> packet_;
  std::unique_ptr<SwsContext, Free> to_yuv_;
  std::int64_t pictures_ = 0;
};

}  // namespace kintsugi::viewer

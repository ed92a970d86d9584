#pragma once
// Small recordings of the other formats, as their own programs write them. The images are those of
// recording_folder.hpp.

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <zlib.h>

#include "mapper/openni2_driver/formats/read_recording.hpp"
#include "mapper/openni2_driver/recording/file_recording.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper::test {

inline FileRecording open_recording_at(const fs::path& path, const ReadingOptions& options = {}) {
  return FileRecording(read_recording(path, options));
}

inline bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

inline std::vector<std::uint8_t> raw_bytes(const cv::Mat& image) {
  return {image.data, image.data + image.total() * image.elemSize()};
}

inline std::vector<std::uint8_t> deflated(const cv::Mat& image) {
  const std::vector<std::uint8_t> bytes = raw_bytes(image);
  std::vector<std::uint8_t> packed(compressBound(bytes.size()));
  uLongf size = packed.size();
  compress(packed.data(), &size, bytes.data(), bytes.size());
  packed.resize(size);
  return packed;
}

inline std::vector<std::uint8_t> encoded(const cv::Mat_<cv::Vec3b>& rgb, const char* extension) {
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, bgr, bytes);
  return bytes;
}

/// Appends little-endian values to a file's bytes.
class Bytes {
 public:
  template <typename T>
  Bytes& put(T value) {
    const auto* start = reinterpret_cast<const char*>(&value);
    bytes_.append(start, sizeof(T));
    return *this;
  }
  Bytes& put(const std::vector<std::uint8_t>& bytes) {
    bytes_.append(bytes.begin(), bytes.end());
    return *this;
  }
  [[nodiscard]] const std::string& text() const { return bytes_; }

 private:
  std::string bytes_;
};

struct KlgImages {
  std::vector<std::uint8_t> depth;
  std::vector<std::uint8_t> color;
};

/// @param announced number of frames that the file says it has
inline std::string klg_bytes(const std::vector<KlgImages>& frames, std::int32_t announced) {
  Bytes bytes;
  bytes.put(announced);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    bytes.put(RecordingFolder::depth_utime(static_cast<int>(i)));
    bytes.put(static_cast<std::int32_t>(frames[i].depth.size()));
    bytes.put(static_cast<std::int32_t>(frames[i].color.size()));
    bytes.put(frames[i].depth).put(frames[i].color);
  }
  return bytes.text();
}

}  // namespace kintsugi::mapper::test

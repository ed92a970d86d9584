#include <cerrno>
#include <fstream>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <zlib.h>

#include "lcmtypes/base/atomic_file.hpp"
#include "mapper/conversion/calibration_writer.hpp"
#include "mapper/conversion/writers.hpp"
#include "mapper/openni2_driver/formats/camera_file.hpp"
#include "mapper/source/frames/depth_values.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

constexpr double kUnits_per_m = 1000.0;

template <typename T>
void put(std::ostream& out, T value) {
  out.write(reinterpret_cast<const char*>(&value), sizeof(value));
}

void put_bytes(std::ostream& out, const std::vector<std::uint8_t>& bytes) {
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
}

std::vector<std::uint8_t> deflated(const cv::Mat_<std::uint16_t>& depth) {
  const uLong num_bytes = depth.total() * sizeof(std::uint16_t);
  std::vector<std::uint8_t> bytes(compressBound(num_bytes));
  uLongf size = bytes.size();
  if (compress2(bytes.data(), &size, depth.data, num_bytes, Z_BEST_SPEED) != Z_OK) {
    throw std::runtime_error("zlib cannot compress a depth image");
  }
  bytes.resize(size);
  return bytes;
}

class KlgWriter : public RecordingWriter {
 public:
  KlgWriter(const fs::path& path, const WritingOptions& options)
      : path_(path), options_(options), file_(path), out_(file_.partial_path(), std::ios::binary) {
    put<std::int32_t>(out_, 0);  // the number of frames: known in the end
    check();
  }

  void add(const RgbdFrame& frame) override {
    if (!camera_) camera_ = frame.intrinsics;
    const auto depth = deflated(depth_values(frame.depth_m, kUnits_per_m));
    const auto color = packed_color(frame.color_rgb);
    put<std::int64_t>(out_, frame.utime);
    put<std::int32_t>(out_, static_cast<std::int32_t>(depth.size()));
    put<std::int32_t>(out_, static_cast<std::int32_t>(color.size()));
    put_bytes(out_, depth);
    put_bytes(out_, color);
    check();
    ++num_frames_;
  }

  void finish(const Trajectory& /*poses*/) override {
    out_.seekp(0);
    put<std::int32_t>(out_, num_frames_);
    out_.close();
    check();
    file_.commit();
    write_calibration(calibration_file_beside(path_), camera_.value(), kUnits_per_m);
  }

 private:
  void check() const {
    if (out_) return;
    throw std::system_error(errno, std::generic_category(),
                            file_.partial_path().string() + ": cannot be written");
  }

  [[nodiscard]] std::vector<std::uint8_t> packed_color(const cv::Mat_<cv::Vec3b>& rgb) const {
    std::vector<std::uint8_t> bytes;
    if (rgb.empty()) return bytes;
    if (options_.jpeg_quality == 0) {
      bytes.assign(rgb.data, rgb.data + rgb.total() * rgb.elemSize());
      return bytes;
    }
    cv::Mat bgr;
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
    cv::imencode(".jpg", bgr, bytes, {cv::IMWRITE_JPEG_QUALITY, options_.jpeg_quality});
    return bytes;
  }

  fs::path path_;
  WritingOptions options_;
  AtomicFile file_;
  std::ofstream out_;  ///< as AtomicFile's stream cannot go back to the number of frames
  std::optional<Intrinsics> camera_;
  std::int32_t num_frames_ = 0;
};

}  // namespace

std::unique_ptr<RecordingWriter> make_klg_writer(const fs::path& file,
                                                 const WritingOptions& options) {
  return std::make_unique<KlgWriter>(file, options);
}

}  // namespace kintsugi::mapper

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "lcmtypes/base/atomic_file.hpp"
#include "mapper/conversion/calibration_writer.hpp"
#include "mapper/conversion/writers.hpp"
#include "mapper/source/frames/depth_values.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

constexpr double kUnits_per_m = 5000.0;

std::string seconds(std::int64_t utime) {
  const std::string micros = std::to_string(1'000'000 + utime % 1'000'000).substr(1);
  return std::to_string(utime / 1'000'000) + "." + micros;
}

void write_png(const fs::path& file, const cv::Mat& image) {
  constexpr int kFast = 1;
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, kFast});
  AtomicFile out(file);
  out.stream().write(reinterpret_cast<const char*>(bytes.data()),
                     static_cast<std::streamsize>(bytes.size()));
  out.commit();
}

class TumWriter : public RecordingWriter {
 public:
  explicit TumWriter(fs::path folder)
      : folder_(std::move(folder)), partial_(folder_.string() + ".partial") {
    fs::remove_all(partial_);  // of a conversion that was killed
    fs::create_directories(partial_ / "depth");
  }

  ~TumWriter() override {
    std::error_code ignored;
    fs::remove_all(partial_, ignored);
  }
  TumWriter(const TumWriter&) = delete;
  TumWriter& operator=(const TumWriter&) = delete;

  void add(const RgbdFrame& frame) override {
    if (!camera_) camera_ = frame.intrinsics;
    const std::string name = seconds(frame.utime) + ".png";
    write_png(partial_ / "depth" / name, depth_values(frame.depth_m, kUnits_per_m));
    depth_list_ += seconds(frame.utime) + " depth/" + name + "\n";
    if (frame.color_rgb.empty()) return;
    if (color_list_.empty()) fs::create_directories(partial_ / "rgb");
    cv::Mat bgr;
    cv::cvtColor(frame.color_rgb, bgr, cv::COLOR_RGB2BGR);
    write_png(partial_ / "rgb" / name, bgr);
    color_list_ += seconds(frame.utime) + " rgb/" + name + "\n";
  }

  void finish(const Trajectory& poses) override {
    write_text("depth.txt", depth_list_);
    if (!color_list_.empty()) write_text("rgb.txt", color_list_);
    write_calibration(partial_ / "camera.txt", camera_.value(), kUnits_per_m);
    if (!poses.empty()) {
      AtomicFile file(partial_ / "groundtruth.txt");
      write_tum(file.stream(), poses);
      file.commit();
    }
    fs::rename(partial_, folder_);
  }

 private:
  void write_text(const char* name, const std::string& text) const {
    AtomicFile file(partial_ / name);
    file.stream() << text;
    file.commit();
  }

  fs::path folder_;
  fs::path partial_;
  std::optional<Intrinsics> camera_;
  std::string depth_list_;
  std::string color_list_;
};

}  // namespace

std::unique_ptr<RecordingWriter> make_tum_writer(const fs::path& folder) {
  return std::make_unique<TumWriter>(folder);
}

}  // namespace kintsugi::mapper

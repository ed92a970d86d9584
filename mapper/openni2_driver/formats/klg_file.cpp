#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "mapper/openni2_driver/formats/binary_file.hpp"
#include "mapper/openni2_driver/formats/camera_file.hpp"
#include "mapper/openni2_driver/formats/file_formats.hpp"
#include "mapper/openni2_driver/formats/image_header.hpp"
#include "mapper/openni2_driver/formats/packed_image.hpp"

// int32 number of frames; of each frame: int64 microseconds, int32 bytes of depth, int32 bytes of
// colour, depth, colour.

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

constexpr double kUnits_per_m = 1000.0;
constexpr std::int64_t kFrameHeaderBytes = 16;
constexpr std::int64_t kMaxImageBytes = std::int64_t{1} << 30U;

struct KlgFrame {
  std::int64_t utime = 0;
  std::int64_t place = 0;  ///< of the depth, in the file
  std::int64_t depth_bytes = 0;
  std::int64_t color_bytes = 0;
};

/// nullopt: the file ends within the frame. @throws std::runtime_error when it is no frame
std::optional<KlgFrame> read_frame(BinaryFile& file, std::int64_t number) {
  if (file.bytes_left() < kFrameHeaderBytes) return std::nullopt;
  KlgFrame frame;
  const std::int64_t start = file.place();
  frame.utime = file.read<std::int64_t>();
  frame.depth_bytes = file.read<std::int32_t>();
  frame.color_bytes = file.read<std::int32_t>();
  frame.place = file.place();
  if (frame.utime < 0 || frame.depth_bytes <= 0 || frame.depth_bytes > kMaxImageBytes ||
      frame.color_bytes < 0 || frame.color_bytes > kMaxImageBytes) {
    throw std::runtime_error(file.path().string() + ": frame " + std::to_string(number) +
                             " at byte " + std::to_string(start) + " says that it has " +
                             std::to_string(frame.depth_bytes) + " bytes of depth and " +
                             std::to_string(frame.color_bytes) + " of colour at " +
                             std::to_string(frame.utime) + " us");
  }
  if (frame.depth_bytes + frame.color_bytes > file.bytes_left()) return std::nullopt;
  file.skip(frame.depth_bytes + frame.color_bytes);
  return frame;
}

/// The size of an image of so many pixels in the proportions that depth cameras have.
std::optional<cv::Size> size_of(std::int64_t num_pixels) {
  constexpr std::array<std::pair<int, int>, 5> kProportions = {
      {{4, 3}, {16, 9}, {53, 30}, {5, 4}, {1, 1}}};  // 53:30 is 848x480
  for (const auto& [x, y] : kProportions) {
    const auto unit = static_cast<std::int64_t>(
        std::llround(std::sqrt(static_cast<double>(num_pixels) / (x * y))));
    if (unit * unit * x * y == num_pixels) {
      return cv::Size(static_cast<int>(unit) * x, static_cast<int>(unit) * y);
    }
  }
  return std::nullopt;
}

/// From the header of the compressed colour image, or else from the number of bytes of the depth.
cv::Size find_size(BinaryFile& file, const KlgFrame& frame) {
  file.seek(frame.place);
  const auto depth = file.read_bytes(frame.depth_bytes);
  const auto color = file.read_bytes(frame.color_bytes);
  const auto header = read_image_header(color);
  if (header && !header->size.empty()) return header->size;
  const std::int64_t inflated = inflated_size(depth);
  const std::int64_t depth_bytes = inflated > 0 ? inflated : frame.depth_bytes;
  const auto size = depth_bytes % 2 == 0 ? size_of(depth_bytes / 2) : std::nullopt;
  if (!size) {
    throw std::runtime_error(file.path().string() + ": the first depth image has " +
                             std::to_string(depth_bytes) +
                             " bytes, which is no image of 4:3, 16:9, 848:480, 5:4 or 1:1");
  }
  return *size;
}

/// What Kintinuous and ElasticFusion take when they are told nothing.
Intrinsics default_camera(cv::Size size) {
  const double scale = static_cast<double>(size.width) / 640.0;
  return {.fx = 528.0 * scale,
          .fy = 528.0 * scale,
          .cx = 0.5 * size.width,
          .cy = 0.5 * size.height,
          .width = size.width,
          .height = size.height,
          .distortion = {}};
}

class KlgImages : public ImageStore {
 public:
  KlgImages(BinaryFile file, cv::Size size, bool swap_colors)
      : file_(std::move(file)), size_(size), swap_colors_(swap_colors) {}

  void add_depth(const KlgFrame& frame) { depth_.push_back(frame); }
  void add_color(const KlgFrame& frame) { color_.push_back(frame); }

  [[nodiscard]] cv::Mat depth(int index) override {
    const KlgFrame& frame = depth_.at(static_cast<std::size_t>(index));
    file_.seek(frame.place);
    return unpack_depth(file_.read_bytes(frame.depth_bytes), size_, what(frame));
  }

  [[nodiscard]] cv::Mat_<cv::Vec3b> color(int index) override {
    const KlgFrame& frame = color_.at(static_cast<std::size_t>(index));
    file_.seek(frame.place + frame.depth_bytes);
    auto color = unpack_color(file_.read_bytes(frame.color_bytes), size_, what(frame));
    if (swap_colors_) cv::cvtColor(color, color, cv::COLOR_BGR2RGB);
    return color;
  }

 private:
  [[nodiscard]] std::string what(const KlgFrame& frame) const {
    return file_.path().string() + ": frame of " + std::to_string(frame.utime) + " us";
  }

  BinaryFile file_;
  cv::Size size_;
  bool swap_colors_ = false;
  std::vector<KlgFrame> depth_;
  std::vector<KlgFrame> color_;
};

}  // namespace

bool is_klg_file(const fs::path& path) {
  try {
    BinaryFile file(path);
    const auto announced = file.read<std::int32_t>();
    // A log that was cut off while it was written says 0 frames.
    return announced >= 0 && read_frame(file, 0).has_value();
  } catch (const std::runtime_error&) {
    return false;
  }
}

RecordingContents read_klg_file(const fs::path& path, bool swap_colors) {
  BinaryFile file(path);
  const auto announced = file.read<std::int32_t>();
  std::vector<KlgFrame> frames;
  std::int64_t num_out_of_order = 0;
  while (const auto frame = read_frame(file, static_cast<std::int64_t>(frames.size()))) {
    if (!frames.empty() && frame->utime <= frames.back().utime) {
      ++num_out_of_order;
    } else {
      frames.push_back(*frame);
    }
  }
  if (frames.empty()) throw std::runtime_error(path.string() + ": has no complete frame");
  RecordingContents contents;
  contents.format = "log of Kintinuous and ElasticFusion (.klg)";
  contents.name = path.filename().string();
  const auto num_read = static_cast<std::int64_t>(frames.size()) + num_out_of_order;
  if (num_read != announced) {
    contents.remarks.push_back("it says that it has " + std::to_string(announced) +
                               " frames, and " + std::to_string(num_read) + " are complete");
  }
  if (num_out_of_order > 0) {
    contents.remarks.push_back(std::to_string(num_out_of_order) +
                               " frames that are not after the one before are left out");
  }
  cv::Size size = find_size(file, frames.front());
  const auto beside = calibration_beside(path);
  contents.calibration = beside.value_or(
      Calibration{.intrinsics = default_camera(size), .depth_units_per_m = kUnits_per_m});
  if (beside) {
    size = {beside->intrinsics.width, beside->intrinsics.height};
  } else {
    contents.remarks.emplace_back(
        "a .klg has no camera: taken is the default of Kintinuous and ElasticFusion (focal length "
        "528 "
        "pixels at a width of 640); --calibration gives the right one");
  }
  auto images = std::make_unique<KlgImages>(std::move(file), size, swap_colors);
  for (const KlgFrame& frame : frames) {
    contents.depth_utimes.push_back(frame.utime);
    images->add_depth(frame);
    if (frame.color_bytes == 0) continue;
    contents.color_utimes.push_back(frame.utime);
    images->add_color(frame);
  }
  contents.images = std::move(images);
  return contents;
}

}  // namespace kintsugi::mapper

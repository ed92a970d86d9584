#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "mapper/openni2_driver/formats/binary_file.hpp"
#include "mapper/openni2_driver/formats/camera_file.hpp"
#include "mapper/openni2_driver/formats/file_formats.hpp"
#include "mapper/openni2_driver/formats/frame_numbers.hpp"
#include "mapper/openni2_driver/formats/frame_stamps.hpp"
#include "mapper/openni2_driver/formats/packed_image.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kVersion = 4;
constexpr std::uint64_t kMaxNameBytes = 1024;
constexpr std::int64_t kFrameHeaderBytes = 64 + 4 * 8;

struct SensHeader {
  std::string sensor;
  Intrinsics color;
  Intrinsics depth;
  Pose color_X_RC = Pose::Identity();  ///< of the depth camera in the colour camera
  double depth_units_per_m = 1000.0;
  std::uint64_t num_frames = 0;
};

Eigen::Matrix4d read_matrix(BinaryFile& file) {
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 16; ++i) matrix(i / 4, i % 4) = static_cast<double>(file.read<float>());
  return matrix;
}

[[noreturn]] void fail(const BinaryFile& file, const std::string& what) {
  throw std::runtime_error(file.path().string() + ": " + what);
}

int read_side(BinaryFile& file) {
  constexpr std::uint32_t kMaxSide = 4096;  // several times what depth cameras have
  const auto side = file.read<std::uint32_t>();
  if (side > kMaxSide) fail(file, "an image has a side of " + std::to_string(side) + " pixels");
  return static_cast<int>(side);
}

Intrinsics camera_of(const Eigen::Matrix4d& K, int width, int height) {
  return {.fx = K(0, 0),
          .fy = K(1, 1),
          .cx = K(0, 2),
          .cy = K(1, 2),
          .width = width,
          .height = height,
          .distortion = {}};
}

bool is_camera(const Intrinsics& camera) {
  const bool is_finite = std::isfinite(camera.fx) && std::isfinite(camera.fy) &&
                         std::isfinite(camera.cx) && std::isfinite(camera.cy);
  return is_finite && camera.fx > 0.0 && camera.fy > 0.0 && camera.width > 0 && camera.height > 0;
}

SensHeader read_header(BinaryFile& file) {
  const auto version = file.read<std::uint32_t>();
  if (version != kVersion) {
    fail(file, "is of version " + std::to_string(version) + ", expected 4");
  }
  const auto name_bytes = file.read<std::uint64_t>();
  if (name_bytes > kMaxNameBytes) fail(file, "the name of its sensor is too long");
  const auto name = file.read_bytes(static_cast<std::int64_t>(name_bytes));
  SensHeader header;
  header.sensor.assign(name.begin(), name.end());
  const Eigen::Matrix4d color_K = read_matrix(file);
  const auto X_DR = rigid(read_matrix(file));
  const Eigen::Matrix4d depth_K = read_matrix(file);
  const auto X_DC = rigid(read_matrix(file));
  if (X_DR && X_DC) header.color_X_RC = X_DR->inverse(Eigen::Isometry) * *X_DC;
  (void)file.read<std::int32_t>();  // compression of colour: seen by the images themselves
  constexpr std::int32_t kOcciDepth = 2;
  if (file.read<std::int32_t>() == kOcciDepth) {
    fail(file, "its depth is compressed with OCCI, expected raw or zlib");
  }
  const int color_width = read_side(file);
  const int color_height = read_side(file);
  const int depth_width = read_side(file);
  const int depth_height = read_side(file);
  header.color = camera_of(color_K, color_width, color_height);
  header.depth = camera_of(depth_K, depth_width, depth_height);
  header.depth_units_per_m = static_cast<double>(file.read<float>());
  header.num_frames = file.read<std::uint64_t>();
  if (!is_camera(header.depth) || !(header.depth_units_per_m > 0.0)) {
    fail(file, "its depth camera is none");
  }
  return header;
}

struct SensFrame {
  std::int64_t place = 0;  ///< of the colour, in the file
  std::int64_t color_bytes = 0;
  std::int64_t depth_bytes = 0;
  std::uint64_t stamp = 0;  ///< of the depth
  std::optional<Pose> X_WC;
};

/// nullopt: the file ends within the frame.
std::optional<SensFrame> read_frame(BinaryFile& file) {
  if (file.bytes_left() < kFrameHeaderBytes) return std::nullopt;
  SensFrame frame;
  frame.X_WC = rigid(read_matrix(file));
  (void)file.read<std::uint64_t>();  // time of the colour image
  frame.stamp = file.read<std::uint64_t>();
  const auto color_bytes = file.read<std::uint64_t>();
  const auto depth_bytes = file.read<std::uint64_t>();
  frame.place = file.place();
  const auto left = static_cast<std::uint64_t>(file.bytes_left());
  if (color_bytes > left || depth_bytes > left - color_bytes) return std::nullopt;
  frame.color_bytes = static_cast<std::int64_t>(color_bytes);
  frame.depth_bytes = static_cast<std::int64_t>(depth_bytes);
  file.skip(frame.color_bytes + frame.depth_bytes);
  return frame;
}

/// What is made for the cameras takes memory by their sizes: these must be those of an image.
void check_depth_size(BinaryFile& file, const SensHeader& header,
                      const std::vector<SensFrame>& frames) {
  const cv::Size size(header.depth.width, header.depth.height);
  const bool is_size = std::ranges::any_of(frames, [&](const SensFrame& frame) {
    file.seek(frame.place + frame.color_bytes);
    return can_be_depth(file.read_bytes(frame.depth_bytes), size);
  });
  if (is_size) return;
  fail(file, "none of its depth images has the size that it says, " + std::to_string(size.width) +
                 "x" + std::to_string(size.height));
}

class SensImages : public ImageStore {
 public:
  SensImages(BinaryFile file, const SensHeader& header, std::vector<SensFrame> frames,
             std::vector<int> with_color)
      : file_(std::move(file)),
        depth_size_(header.depth.width, header.depth.height),
        color_size_(header.color.width, header.color.height),
        frames_(std::move(frames)),
        with_color_(std::move(with_color)) {}

  [[nodiscard]] cv::Mat depth(int index) override {
    const SensFrame& frame = frames_.at(static_cast<std::size_t>(index));
    file_.seek(frame.place + frame.color_bytes);
    return unpack_depth(file_.read_bytes(frame.depth_bytes), depth_size_, what(index));
  }

  [[nodiscard]] cv::Mat_<cv::Vec3b> color(int index) override {
    const int number = with_color_.at(static_cast<std::size_t>(index));
    const SensFrame& frame = frames_.at(static_cast<std::size_t>(number));
    file_.seek(frame.place);
    return unpack_color(file_.read_bytes(frame.color_bytes), color_size_, what(number));
  }

 private:
  [[nodiscard]] std::string what(int number) const {
    return file_.path().string() + ": frame " + std::to_string(number);
  }

  BinaryFile file_;
  cv::Size depth_size_;
  cv::Size color_size_;
  std::vector<SensFrame> frames_;
  std::vector<int> with_color_;  ///< frame of each colour image
};

std::vector<std::int64_t> times_of(const std::vector<SensFrame>& frames,
                                   std::vector<std::string>& remarks) {
  std::vector<std::uint64_t> stamps;
  stamps.reserve(frames.size());
  std::ranges::transform(frames, std::back_inserter(stamps), &SensFrame::stamp);
  if (auto utimes = times_of_stamps(stamps)) return *std::move(utimes);
  remarks.push_back("its times do not ascend: mapped at " + std::to_string(kNumberedFrames_Hz) +
                    " frames a second");
  return times_of_numbers(frames.size());
}

}  // namespace

bool is_sens_file(const fs::path& path) {
  try {
    BinaryFile file(path);
    (void)read_header(file);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

RecordingContents read_sens_file(const fs::path& path) {
  BinaryFile file(path);
  const SensHeader header = read_header(file);
  std::vector<SensFrame> frames;
  while (frames.size() < header.num_frames) {
    auto frame = read_frame(file);
    if (!frame) break;
    frames.push_back(*std::move(frame));
  }
  if (frames.empty()) throw std::runtime_error(path.string() + ": has no complete frame");
  check_depth_size(file, header, frames);
  RecordingContents contents;
  contents.format = "sensor stream of ScanNet (.sens)";
  contents.name = header.sensor.empty() ? path.filename().string() : header.sensor;
  if (frames.size() != header.num_frames) {
    contents.remarks.push_back("it says that it has " + std::to_string(header.num_frames) +
                               " frames, and " + std::to_string(frames.size()) + " are complete");
  }
  contents.calibration = {.intrinsics = header.depth,
                          .depth_units_per_m = header.depth_units_per_m};
  contents.depth_utimes = times_of(frames, contents.remarks);
  std::vector<int> with_color;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    contents.depth_X_WC.push_back(frames[i].X_WC);
    if (frames[i].color_bytes == 0 || !is_camera(header.color)) continue;
    with_color.push_back(static_cast<int>(i));
    contents.color_utimes.push_back(contents.depth_utimes[i]);
  }
  const bool same_pixels =
      header.color == header.depth && header.color_X_RC.isApprox(Pose::Identity(), 1e-9);
  if (!with_color.empty() && !same_pixels) {
    contents.color_camera = ColorCamera{.intrinsics = header.color, .X_RC = header.color_X_RC};
  }
  contents.images = std::make_unique<SensImages>(std::move(file), header, std::move(frames),
                                                 std::move(with_color));
  return contents;
}

}  // namespace kintsugi::mapper

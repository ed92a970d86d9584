#include "mapper/openni2_driver/recording/folder_recording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/core.hpp>

#include "mapper/openni2_driver/recording/frame_numbers.hpp"
#include "mapper/openni2_driver/recording/image_decoder.hpp"

namespace kintsugi::mapper {
namespace {

constexpr std::size_t kNumRawValues = 1U << 16U;

int nominal_rate_hz(const std::vector<TimedImage>& images) {
  constexpr int kRateOfOneImage = 30;
  if (images.size() < 2) return kRateOfOneImage;
  std::vector<std::int64_t> intervals_us;
  for (std::size_t i = 1; i < images.size(); ++i) {
    intervals_us.push_back(images[i].utime - images[i - 1].utime);
  }
  const auto median = intervals_us.begin() + static_cast<std::ptrdiff_t>(intervals_us.size() / 2);
  std::nth_element(intervals_us.begin(), median, intervals_us.end());
  return static_cast<int>(std::clamp(std::lround(1e6 / static_cast<double>(*median)), 1L, 1000L));
}

cv::Size image_size(const Intrinsics& intrinsics) { return {intrinsics.width, intrinsics.height}; }

}  // namespace

FolderRecording::FolderRecording(const std::filesystem::path& folder)
    : folder_(folder),
      images_(read_image_lists(folder)),
      has_frame_numbers_(mapper::has_frame_numbers(images_)) {
  if (has_frame_numbers_) replace_frame_numbers(images_);
  frame_rate_hz_ = nominal_rate_hz(images_.depth);
  calibration_ = read_calibration(folder / "camera.txt");
  tables_ = {make_table(DepthUnit::k1mm), make_table(DepthUnit::k100um)};
}

std::string FolderRecording::name() const {
  return std::filesystem::absolute(folder_ / "").parent_path().filename().string();
}

std::string FolderRecording::remark() const {
  if (!has_frame_numbers_) return "";
  return "the times of the images are frame numbers, not seconds: mapped at " +
         std::to_string(kNumberedFrames_Hz) + " frames a second";
}

DepthUnit FolderRecording::finest_depth_unit() const {
  return calibration_.depth_units_per_m > units_per_m(DepthUnit::k1mm) ? DepthUnit::k100um
                                                                       : DepthUnit::k1mm;
}

int FolderRecording::num_depth_frames() const { return static_cast<int>(images_.depth.size()); }

int FolderRecording::num_color_frames() const { return static_cast<int>(images_.color.size()); }

std::int64_t FolderRecording::depth_utime(int index) const {
  return images_.depth.at(static_cast<std::size_t>(index)).utime;
}

std::int64_t FolderRecording::color_utime(int index) const {
  return images_.color.at(static_cast<std::size_t>(index)).utime;
}

cv::Mat_<std::uint16_t> FolderRecording::depth(int index, DepthUnit unit) {
  const std::filesystem::path& file = images_.depth.at(static_cast<std::size_t>(index)).file;
  cv::Mat_<std::uint16_t> depth =
      decode_depth(read_bytes(file), image_size(intrinsics()), file.string());
  const DepthTable& table = tables_.at(static_cast<std::size_t>(unit));
  std::transform(depth[0], depth[0] + depth.total(), depth[0],
                 [&](std::uint16_t raw) { return table[raw]; });
  return depth;
}

cv::Mat_<cv::Vec3b> FolderRecording::color(int index) {
  const std::filesystem::path& file = images_.color.at(static_cast<std::size_t>(index)).file;
  return decode_color(read_bytes(file), image_size(intrinsics()), file.string());
}

FolderRecording::DepthTable FolderRecording::make_table(DepthUnit unit) const {
  constexpr std::size_t kSaturated = kNumRawValues - 1;
  DepthTable table(kNumRawValues, 0);
  const double scale = units_per_m(unit) / calibration_.depth_units_per_m;
  for (std::size_t raw = 1; raw < kSaturated; ++raw) {
    const double value = std::round(static_cast<double>(raw) * scale);
    if (value <= max_depth_value(unit)) table[raw] = static_cast<std::uint16_t>(value);
  }
  return table;
}

}  // namespace kintsugi::mapper

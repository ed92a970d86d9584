#include "mapper/openni2_driver/recording/file_recording.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kintsugi::mapper {
namespace {

constexpr std::size_t kNumRawValues = 1U << 16U;

int nominal_rate_hz(const std::vector<std::int64_t>& utimes) {
  constexpr int kRateOfOneImage = 30;
  if (utimes.size() < 2) return kRateOfOneImage;
  std::vector<std::int64_t> intervals_us;
  intervals_us.reserve(utimes.size() - 1);
  for (std::size_t i = 1; i < utimes.size(); ++i) {
    intervals_us.push_back(utimes[i] - utimes[i - 1]);
  }
  const auto median = intervals_us.begin() + static_cast<std::ptrdiff_t>(intervals_us.size() / 2);
  std::nth_element(intervals_us.begin(), median, intervals_us.end());
  return static_cast<int>(std::clamp(std::lround(1e6 / static_cast<double>(*median)), 1L, 1000L));
}

/// 0 where the depth is invalid or beyond the unit's range.
std::uint16_t in_unit(double depth_m, DepthUnit unit) {
  const double value = std::round(depth_m * units_per_m(unit));
  return value >= 1.0 && value <= max_depth_value(unit) ? static_cast<std::uint16_t>(value)
                                                        : std::uint16_t{0};
}

}  // namespace

FileRecording::FileRecording(RecordingContents contents)
    : contents_(std::move(contents)), frame_rate_hz_(nominal_rate_hz(contents_.depth_utimes)) {
  tables_ = {make_table(DepthUnit::k1mm), make_table(DepthUnit::k100um)};
  if (contents_.color_camera) registration_.emplace(intrinsics(), *contents_.color_camera);
}

std::string FileRecording::remark() const {
  std::string text;
  for (const std::string& remark : contents_.remarks) text += (text.empty() ? "" : "; ") + remark;
  return text;
}

DepthUnit FileRecording::finest_depth_unit() const {
  return contents_.calibration.depth_units_per_m > units_per_m(DepthUnit::k1mm) ? DepthUnit::k100um
                                                                                : DepthUnit::k1mm;
}

int FileRecording::num_depth_frames() const {
  return static_cast<int>(contents_.depth_utimes.size());
}

int FileRecording::num_color_frames() const {
  return static_cast<int>(contents_.color_utimes.size());
}

std::int64_t FileRecording::depth_utime(int index) const {
  return contents_.depth_utimes.at(static_cast<std::size_t>(index));
}

std::int64_t FileRecording::color_utime(int index) const {
  return contents_.color_utimes.at(static_cast<std::size_t>(index));
}

cv::Mat_<std::uint16_t> FileRecording::depth(int index, DepthUnit unit) {
  const cv::Mat stored = contents_.images->depth(index);
  cv::Mat_<std::uint16_t> depth(stored.size());
  if (stored.type() == CV_32FC1) {
    const cv::Mat_<float> depth_m = stored;
    std::transform(depth_m.begin(), depth_m.end(), depth.begin(),
                   [&](float z) { return in_unit(static_cast<double>(z), unit); });
    return depth;
  }
  const cv::Mat_<std::uint16_t> raw = stored;
  const DepthTable& table = tables_.at(static_cast<std::size_t>(unit));
  std::transform(raw.begin(), raw.end(), depth.begin(),
                 [&](std::uint16_t value) { return table[value]; });
  return depth;
}

cv::Mat_<cv::Vec3b> FileRecording::color(int index) {
  cv::Mat_<cv::Vec3b> color = contents_.images->color(index);
  if (!registration_) return color;
  cv::Mat_<float> depth_m;
  if (registration_->needs_depth()) {
    cv::Mat(depth(depth_index_near(color_utime(index)), DepthUnit::k1mm))
        .convertTo(depth_m, CV_32F, 1.0 / units_per_m(DepthUnit::k1mm));
  }
  return registration_->apply(color, depth_m);
}

std::optional<Pose> FileRecording::depth_X_WC(int index) const {
  if (contents_.depth_X_WC.empty()) return std::nullopt;
  return contents_.depth_X_WC.at(static_cast<std::size_t>(index));
}

FileRecording::DepthTable FileRecording::make_table(DepthUnit unit) const {
  constexpr std::size_t kSaturated = kNumRawValues - 1;
  DepthTable table(kNumRawValues, 0);
  for (std::size_t raw = 1; raw < kSaturated; ++raw) {
    table[raw] = in_unit(static_cast<double>(raw) / contents_.calibration.depth_units_per_m, unit);
  }
  return table;
}

int FileRecording::depth_index_near(std::int64_t utime) const {
  const auto& utimes = contents_.depth_utimes;
  const auto after = std::ranges::lower_bound(utimes, utime);
  if (after == utimes.begin()) return 0;
  const auto before = after - 1;
  const bool is_nearer = after == utimes.end() || utime - *before <= *after - utime;
  return static_cast<int>((is_nearer ? before : after) - utimes.begin());
}

}  // namespace kintsugi::mapper

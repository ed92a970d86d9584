#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "mapper/openni2_driver/formats/color_registration.hpp"
#include "mapper/openni2_driver/formats/recording_contents.hpp"
#include "mapper/openni2_driver/recording/recording.hpp"

namespace kintsugi::mapper {

/// A recording in one of the formats that `read_recording()` knows: depth in the driver's units,
/// colour with the pixels of the depth camera.
class FileRecording : public Recording {
 public:
  explicit FileRecording(RecordingContents contents);

  [[nodiscard]] std::string name() const override { return contents_.name; }
  [[nodiscard]] std::string remark() const override;
  [[nodiscard]] const Intrinsics& intrinsics() const override {
    return contents_.calibration.intrinsics;
  }
  /// From the median interval between depth images.
  [[nodiscard]] int frame_rate_hz() const override { return frame_rate_hz_; }
  [[nodiscard]] DepthUnit finest_depth_unit() const override;
  [[nodiscard]] int num_depth_frames() const override;
  [[nodiscard]] int num_color_frames() const override;
  [[nodiscard]] std::int64_t depth_utime(int index) const override;
  [[nodiscard]] std::int64_t color_utime(int index) const override;
  [[nodiscard]] cv::Mat_<std::uint16_t> depth(int index, DepthUnit unit) override;
  [[nodiscard]] cv::Mat_<cv::Vec3b> color(int index) override;
  [[nodiscard]] std::optional<Pose> depth_X_WC(int index) const override;

  /// What the reader found.
  [[nodiscard]] const RecordingContents& contents() const { return contents_; }

 private:
  using DepthTable = std::vector<std::uint16_t>;  ///< converted value of each raw value

  [[nodiscard]] DepthTable make_table(DepthUnit unit) const;
  [[nodiscard]] int depth_index_near(std::int64_t utime) const;

  RecordingContents contents_;
  int frame_rate_hz_ = 0;
  std::array<DepthTable, 2> tables_;  ///< by DepthUnit
  std::optional<ColorRegistration> registration_;
};

}  // namespace kintsugi::mapper

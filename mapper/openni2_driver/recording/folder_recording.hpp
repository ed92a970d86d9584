#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "mapper/openni2_driver/recording/calibration.hpp"
#include "mapper/openni2_driver/recording/image_list.hpp"
#include "mapper/openni2_driver/recording/recording.hpp"

namespace kintsugi::mapper {

/// A recording in the layout of the TUM RGB-D benchmark: depth.txt and rgb.txt or associations.txt,
/// the images they list (16-bit PNG depth, 8-bit colour), and camera.txt.
///
/// Besides raw 0, raw 65535 is invalid (7-Scenes). Frame numbers instead of times (ICL-NUIM) are
/// taken at 30 Hz.
class FolderRecording : public Recording {
 public:
  /// Reads the lists and camera.txt, but no images.
  /// @throws std::runtime_error naming file, line and what was expected
  explicit FolderRecording(const std::filesystem::path& folder);

  [[nodiscard]] std::string name() const override;
  [[nodiscard]] std::string remark() const override;
  [[nodiscard]] const Intrinsics& intrinsics() const override { return calibration_.intrinsics; }
  /// From the median interval between depth images.
  [[nodiscard]] int frame_rate_hz() const override { return frame_rate_hz_; }
  [[nodiscard]] DepthUnit finest_depth_unit() const override;
  [[nodiscard]] int num_depth_frames() const override;
  [[nodiscard]] int num_color_frames() const override;
  [[nodiscard]] std::int64_t depth_utime(int index) const override;
  [[nodiscard]] std::int64_t color_utime(int index) const override;
  [[nodiscard]] cv::Mat_<std::uint16_t> depth(int index, DepthUnit unit) override;
  [[nodiscard]] cv::Mat_<cv::Vec3b> color(int index) override;

 private:
  using DepthTable = std::vector<std::uint16_t>;  ///< converted value of each raw value

  [[nodiscard]] DepthTable make_table(DepthUnit unit) const;

  std::filesystem::path folder_;
  Calibration calibration_;
  ImageLists images_;
  bool has_frame_numbers_ = false;  ///< in its lists, instead of times
  int frame_rate_hz_ = 0;
  std::array<DepthTable, 2> tables_;  ///< by DepthUnit
};

}  // namespace kintsugi::mapper

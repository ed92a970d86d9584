#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mapper/openni2_driver/recording/camera_imitation.hpp"
#include "mapper/openni2_driver/recording/recording.hpp"

namespace kintsugi::mapper {

/// A recording with the faults of an imitated camera: missing images, clocks that differ or jump,
/// and, after an interruption, only the remaining images.
class ImitatedRecording : public Recording {
 public:
  /// @param resume_utime time in the recording at which the camera is back after an interruption;
  ///   absent: there was none
  ImitatedRecording(std::unique_ptr<Recording> recording, const CameraImitation& imitation,
                    std::optional<std::int64_t> resume_utime);

  [[nodiscard]] std::string name() const override { return recording_->name(); }
  [[nodiscard]] std::string remark() const override { return recording_->remark(); }
  [[nodiscard]] const Intrinsics& intrinsics() const override { return recording_->intrinsics(); }
  [[nodiscard]] int frame_rate_hz() const override { return recording_->frame_rate_hz(); }
  [[nodiscard]] DepthUnit finest_depth_unit() const override {
    return recording_->finest_depth_unit();
  }
  [[nodiscard]] int num_depth_frames() const override { return static_cast<int>(depths_.size()); }
  [[nodiscard]] int num_color_frames() const override { return static_cast<int>(colors_.size()); }
  [[nodiscard]] std::int64_t depth_utime(int index) const override;
  [[nodiscard]] std::int64_t color_utime(int index) const override;
  [[nodiscard]] std::int64_t depth_stamp(int index) const override;
  [[nodiscard]] std::int64_t color_stamp(int index) const override;
  [[nodiscard]] std::int64_t color_delay_us() const override { return imitation_.color_delay_us; }
  [[nodiscard]] cv::Mat_<std::uint16_t> depth(int index, DepthUnit unit) override;
  [[nodiscard]] cv::Mat_<cv::Vec3b> color(int index) override;
  [[nodiscard]] std::optional<Pose> depth_X_WC(int index) const override;

 private:
  [[nodiscard]] bool color_comes(int index) const;
  [[nodiscard]] std::int64_t clock(std::int64_t utime) const;

  std::unique_ptr<Recording> recording_;
  CameraImitation imitation_;
  std::vector<int> depths_;  ///< indices of the images that are not missing
  std::vector<int> colors_;
  std::int64_t clock_zero_ = 0;                   ///< time of the recording at which the clock is 0
  std::optional<std::int64_t> clock_jump_utime_;  ///< of the recording; absent: no jump
};

}  // namespace kintsugi::mapper
